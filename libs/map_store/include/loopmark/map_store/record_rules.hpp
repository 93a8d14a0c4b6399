// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What must hold of the records of a run before anything computes with them: a run may come from anyone. Each function
/// throws InputError with the file, the line and what is impossible about it.
#pragma once

#include <filesystem>
#include <vector>

#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/map_store/records.hpp"

namespace loopmark::map_store {

/// Scans stand in order (number i in line i + 1), pieces and keyframes are numbered without gaps, numbers are finite
/// and poses rigid.
void require_sound(const std::vector<ScanRecord>& scans, const std::filesystem::path& file);

/// Loops join two different keyframes that are there, the later to the earlier one.
void require_sound(const std::vector<LoopRecord>& loops, std::size_t keyframes, const std::filesystem::path& file);
void require_sound(const std::vector<LoopDecision>& decisions, std::size_t keyframes,
                   const std::filesystem::path& file);

std::size_t keyframes_in(const std::vector<ScanRecord>& scans);

}  // namespace loopmark::map_store

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a person has decided about loops, whatever the evidence says. A run keeps it (records/decisions.rec).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"

namespace loopmark::map_store {

enum class LoopOverride {
  kVeto,  ///< the loop takes no part
  kForce  ///< the loop is trusted as odometry is
};

struct LoopDecision {
  std::size_t source = 0;  ///< keyframe numbers: the later,
  std::size_t target = 0;  ///< and the earlier one
  LoopOverride loop_override = LoopOverride::kVeto;
};

/// "vetoed by a person", "forced by a person".
std::string to_string(LoopOverride loop_override);

/// What was decided about the loop, if anything.
std::optional<LoopOverride> loop_override_of(const std::vector<LoopDecision>& decisions, std::size_t source,
                                             std::size_t target);

std::filesystem::path decisions_file(const RunFolder& run);

/// The decisions kept in a run, none where nobody decided anything, whatever keyframes they name (read_run_records
/// holds them against the others). Throws InputError when the file is damaged.
std::vector<LoopDecision> read_loop_decisions(const RunFolder& run);

/// Replaces the decisions kept in a run that is being made.
void write_loop_decisions(const RunFolder& run, const std::vector<LoopDecision>& decisions);

}  // namespace loopmark::map_store

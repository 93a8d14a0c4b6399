// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/map_store/records.hpp"
#include "loopmark/map_store/run_folder.hpp"

namespace loopmark::map_store {

/// Replaces the loop records of a run that is being made.
void write_loop_records(const RunFolder& run, const std::vector<LoopRecord>& records);

/// What a run remembers, in order. Throws InputError when a record is damaged.
std::vector<ScanRecord> read_scan_records(const RunFolder& run);
std::vector<LoopRecord> read_loop_records(const RunFolder& run);

}  // namespace loopmark::map_store

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/map_store/records.hpp"
#include "loopmark/map_store/run_folder.hpp"

namespace loopmark::map_store {

/// Replaces the loop records of a run that is being made.
void write_loop_records(const RunFolder& run, const std::vector<LoopRecord>& records);

/// What a run remembers, in order.
struct RunRecords {
  std::vector<ScanRecord> scans;
  std::vector<LoopRecord> loops;
  std::vector<LoopDecision> decisions;
};

/// The only way to the records of a run, whole or in the making. Throws InputError with file and line when a record is
/// damaged or says what cannot be: an index of something that is not there, a number that is none.
RunRecords read_run_records(const RunFolder& run);

}  // namespace loopmark::map_store

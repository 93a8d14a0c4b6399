// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Several runs joined into one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/multi_session/inter_session_loops.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows {

/// The runs to merge, as they were read.
struct MergeInput {
  std::vector<std::filesystem::path> runs;
  multi_session::SessionSet set;
  std::vector<std::vector<Pose>> truth;  ///< of each drive's scans, where its run holds it; each in a frame of its own
};

/// Reads the runs. Throws InputError for what is no run, is not whole, was made by another version, or holds a drive
/// that another one holds, too.
MergeInput read_runs(const std::vector<std::filesystem::path>& runs);

/// The part of `poses` (one for each scan of a run, or none) that is a drive's.
std::vector<Pose> poses_of(const multi_session::SessionRecord& drive, const std::vector<Pose>& poses);

struct MergeOutcome {
  MapOutcome map;
  std::filesystem::path run;
  std::vector<std::string> warnings;  ///< a line for each drive that was left out
};

/// Joins the drives in `folder` (a new run, in the making) and writes all that `map` writes. `one_frame`: the true
/// poses of all drives are in one frame, so that the whole can be judged; throws InputError when a drive has none.
/// Throws InputError when no two drives hang together. The folder is not finished: that is the caller's.
MergeOutcome merge_runs(const MergeInput& input, const map_store::RunFolder& folder, const ProgramOptions& options,
                        bool one_frame, const std::vector<std::string>& arguments);

/// The drives of a run by name, with their own errors where `truth` (of all scans, or empty) is known; empty for a run
/// of one drive.
std::vector<DriveSummary> drive_summaries(const std::vector<multi_session::SessionRecord>& drives,
                                          const mapping::SolvedMap& map, const std::vector<Pose>& truth);

/// Seconds from the first to the last scan of each drive, added up.
double driven_s(const std::vector<multi_session::SessionRecord>& drives,
                const std::vector<map_store::ScanRecord>& scans);

}  // namespace loopmark::workflows

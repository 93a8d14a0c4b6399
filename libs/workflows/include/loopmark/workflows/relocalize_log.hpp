// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Finding the scans of a log in the map of a run.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "loopmark/localization/relocalization_report.hpp"
#include "loopmark/mapping/map_truth.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::workflows {

/// What `loopmark relocalize` is asked to do.
struct RelocalizeJob {
  std::filesystem::path run;             ///< a whole run: the map
  std::filesystem::path log;             ///< the drive log to place in it
  std::filesystem::path map_truth = {};  ///< true poses of the run's scans; empty: answers are not judged
  std::filesystem::path truth = {};      ///< true poses of the log's scans; empty: those that lie beside it
  std::size_t every = 1;                 ///< take every n-th scan
  bool single = false;                   ///< place each scan on its own, without the scans before it
};

struct RelocalizeOutcome {
  std::vector<localization::RelocalizedScan> scans;  ///< one for each scan that was taken
  localization::RelocalizationSummary summary;
  std::optional<mapping::MapTruth> map_truth = {};  ///< what answers were judged by, where they were
  std::vector<Pose> true_query = {};                ///< one pose for each scan of the log then
};

/// Places the scans. Throws InputError when the run or the log cannot be used, Interrupted when the user asks to stop.
RelocalizeOutcome relocalize_log(const RelocalizeJob& job, const ProgramOptions& options);

}  // namespace loopmark::workflows

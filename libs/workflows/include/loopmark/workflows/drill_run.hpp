// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/kidnap_benchmark/drill.hpp"
#include "loopmark/workflows/opened_run.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::workflows {

/// What `loopmark drill` is asked to do.
struct DrillJob {
  std::filesystem::path run;          ///< folder of a whole run
  std::filesystem::path log;          ///< its log; empty: where it was when it was mapped
  std::filesystem::path drive;        ///< another drive of the same place; empty: none
  std::filesystem::path drive_truth;  ///< its true poses; empty: what lies beside its scans
  std::filesystem::path map_truth;    ///< true poses of the run's scans; empty: those that it was mapped with
  std::vector<std::size_t> only;      ///< numbers of the events that are run; empty: all
};

struct DrillResult {
  std::string run;
  std::string drive;
  kidnap_benchmark::DrillOptions options;
  std::vector<Pose> T_map_scan;                          ///< of the run
  std::vector<kidnap_benchmark::DrillScan> scans;        ///< that were fed
  std::vector<kidnap_benchmark::DrillScan> drive_scans;  ///< of the other drive
  std::size_t keyframes = 0;                             ///< of the map that was searched
  std::size_t left_out = 0;                              ///< keyframes kept out of it, so that there are scans to feed
  std::vector<kidnap_benchmark::DrillEvent> events;      ///< as planned
  std::vector<kidnap_benchmark::DrillOutcome> outcomes;  ///< one for each event
};

/// `title`: what the report calls the run. Throws InputError (no run, a log that is not there, no truth for another
/// drive) or Interrupted.
DrillResult run_drill(const DrillJob& job, const std::string& title, const ProgramOptions& options);

/// drill.csv (a row an event), summary.json and report.html in `folder`: the same bytes for the same drill. `run`: the
/// folder of the run that was searched.
void write_drill(const std::filesystem::path& folder, const std::filesystem::path& run, const DrillResult& result);

/// Success by stratum and by disturbance, for people.
std::string drill_table(const DrillResult& result);

}  // namespace loopmark::workflows

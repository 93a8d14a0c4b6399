// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A run solved again with other loops, without its log.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/workflows/map_run.hpp"
#include "loopmark/workflows/opened_run.hpp"

namespace loopmark::workflows {

/// What is to change, as people write it: pairs "I-J".
struct LoopChanges {
  std::vector<std::string> veto;
  std::vector<std::string> force;
  std::vector<std::string> forget;  ///< earlier decisions taken back
};

/// Changes the decisions of `run`. A forced pair that was no candidate is registered now and added to its loops.
/// Throws InputError for a pair that is named twice, a veto of what is no candidate, a forced pair between which
/// registration finds no motion at all, and a decision to forget that nobody made.
void apply(const LoopChanges& changes, OpenedRun& run);

/// What a solved run comes to, and what making it took: the latter as the run remembers it.
MapSummary summary_of(const OpenedRun& run, const mapping::SolvedMap& map, const std::vector<Pose>& truth);
MapTimes times_of(const OpenedRun& run);

/// Where the solved run went.
struct Rewritten {
  std::filesystem::path run;
  std::filesystem::path before;  ///< the old run, where the new one took its name
  MapSummary summary;
  double seconds = 0.0;
};

/// Writes `run` as solved to `output` (empty: in its own place, the old run kept beside it), whole or not at all.
/// Clouds, occupancy and MRPT's files are made anew with `maps`, else left out: the old ones show the old poses.
Rewritten rewrite(const OpenedRun& run, const mapping::SolvedMap& map, const std::filesystem::path& output, bool maps,
                  const std::vector<std::string>& arguments);

}  // namespace loopmark::workflows

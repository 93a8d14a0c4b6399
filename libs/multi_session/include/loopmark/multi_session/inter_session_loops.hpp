// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Joins drives into one map with no idea of where they are, and leaves out those that do not belong.
#pragma once

#include <string>
#include <vector>

#include "loopmark/mapping/loop_closer.hpp"
#include "loopmark/multi_session/session_set.hpp"

namespace loopmark::multi_session {

/// What connects two drives. Where the map says that both pass the same place, their scans are compared: a few loops
/// can agree by chance on two places that look alike, but then the drives contradict each other everywhere else.
struct InterSessionLoop {
  std::size_t first = 0;  ///< places in SessionSet::drives
  std::size_t second = 0;
  std::size_t candidates = 0;  ///< pairs of places that were registered
  double best_p = 0.0;         ///< the largest P(correct) among them
  std::size_t accepted = 0;    ///< loops that take part in the map
  std::size_t checked = 0;     ///< pairs of keyframes that the map puts at the same place
  std::size_t agree = 0;       ///< those whose scans say so, too
  bool contradicted = false;   ///< too few of them: the loops between the drives are withdrawn
};

/// What became of a drive.
struct DriveVerdict {
  bool belongs = false;
  std::size_t keyframes = 0;
  std::size_t in_map = 0;  ///< keyframes that have a place in the joined map
  std::string reason;      ///< why it does not belong, with numbers
};

struct JoinedDrives {
  SessionSet set;                                     ///< all drives, with the loops found between them
  mapping::SolvedMap map;                             ///< of the keyframes alone
  std::vector<InterSessionLoop> inter_session_loops;  ///< one for each pair of drives
  std::vector<DriveVerdict> verdicts;                 ///< one for each drive
};

/// Looks for loops between the drives, whose keyframes' files are in `folder`, solves, and judges which drives hang
/// together: the group of most drives is the map. Throws Interrupted when the user asks to stop.
JoinedDrives join_sessions(SessionSet set, const map_store::RunFolder& folder, const mapping::SlamOptions& options,
                           const pose_graph::PoseGraphOptions& graph_options,
                           const registration::PairRegistration& registrar,
                           const mapping::LoopCloser::Report& report = {});

}  // namespace loopmark::multi_session

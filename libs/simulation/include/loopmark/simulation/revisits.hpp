// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/simulation/lane_path.hpp"

namespace loopmark::simulation {

enum class RevisitKind { kSame, kOpposite, kCrossing };
const char* name_of(RevisitKind kind);

/// A stretch of a path that comes back to an earlier stretch.
struct Revisit {
  RevisitKind kind = RevisitKind::kSame;
  double begin_m = 0.0;  ///< along the path, of the later stretch
  double end_m = 0.0;
  double earlier_begin_m = 0.0;  ///< along the path, of the stretch that it meets; begin < end
  double earlier_end_m = 0.0;
  double nearest_m = 0.0;       ///< least distance between the two stretches
  bool near_identical = false;  ///< on the row of blocks that look alike

  double length() const { return end_m - begin_m; }
};

/// What counts as a revisit.
struct RevisitRule {
  double near_m = 8.0;    ///< both stretches lie within this distance
  double gap_m = 60.0;    ///< least driven distance between them
  double least_m = 12.0;  ///< shorter stretches in the same or opposite direction do not count
};

/// All revisits in order. Crossings are meetings at 45 to 135 degrees that no revisit along the street adjoins.
std::vector<Revisit> find_revisits(const LanePath& path, const RoadNetwork& roads, const RevisitRule& rule = {});

}  // namespace loopmark::simulation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "loopmark/surfels/local_map.hpp"

namespace loopmark::localization::internal {

/// Where the sensor was at the stamp of a sweep, and how it moved during it.
struct SweepInMap {
  Pose T_map_lidar = Pose::Identity();
  Vector6d velocity = Vector6d::Zero();  ///< in the lidar's frame, a second
};

/// Finds both at once in a map of the surroundings: the first scan of a moving sensor is distorted by a motion that
/// nothing else tells. Gauss-Newton over the robust (Geman-McClure) distances across the map's planes of
/// q_i = T * exp(t_i v) * p_i, in 12 unknowns. `times`: of the points relative to the stamp, seconds.
/// Nothing when it ends farther than 3 m or 10 deg from `start`, or with a motion no vehicle makes.
std::optional<SweepInMap> align_sweep(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& times,
                                      const surfels::LocalMap& map, const Pose& start);

}  // namespace loopmark::localization::internal

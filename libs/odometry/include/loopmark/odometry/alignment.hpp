// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Alignment of one scan to the local map.
#pragma once

#include <vector>

#include "loopmark/odometry/health.hpp"
#include "loopmark/odometry/local_map.hpp"
#include "loopmark/odometry/options.hpp"

namespace loopmark {

struct Alignment {
  Pose T_map_lidar = Pose::Identity();
  Health health;
};

/// Moves `keypoints` (lidar frame) onto the map from the start `T_map_lidar`: Gauss-Newton over robust
/// (Geman-McClure) distances across the map's planes, with a small weight along them, so that points without
/// a plane count too. `threshold_m`: largest distance of a match.
Alignment align(const std::vector<Eigen::Vector3f>& keypoints, const LocalMap& map, const Pose& T_map_lidar,
                double threshold_m, const OdometryOptions& options);

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Alignment of one scan to the local map.
#pragma once

#include <vector>

#include "loopmark/odometry/options.hpp"
#include "loopmark/odometry/tracking_status.hpp"
#include "loopmark/surfels/local_map.hpp"

namespace loopmark::odometry {

/// Points of a scan that are aligned, lidar frame; `ground`: which of them are probably ground, or empty.
struct Keypoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<bool> ground = {};

  bool is_ground(std::size_t i) const { return !ground.empty() && ground[i]; }
};

struct Alignment {
  Pose T_map_lidar = Pose::Identity();
  TrackingStatus tracking_status;
};

/// Moves `keypoints` onto the map from the start `T_map_lidar`: Gauss-Newton over robust (Geman-McClure) distances
/// across the map's planes, with a small weight along them, so that points without a plane count too; but not along the
/// lidar's z axis, where the rings of a turning sensor lie as its beams do, not as the surface does. Ground counts
/// across its planes only, as the rings in which a sensor sees it move along with the sensor; where nothing else holds
/// the translation, it stays where it starts. `threshold_m`: largest distance of a match.
Alignment align(const Keypoints& keypoints, const surfels::LocalMap& map, const Pose& T_map_lidar, double threshold_m,
                const OdometryOptions& options);

/// The same where nobody knows what is ground.
inline Alignment align(const std::vector<Eigen::Vector3f>& points, const surfels::LocalMap& map,
                       const Pose& T_map_lidar, double threshold_m, const OdometryOptions& options) {
  return align(Keypoints{points}, map, T_map_lidar, threshold_m, options);
}

}  // namespace loopmark::odometry

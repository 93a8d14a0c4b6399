// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/options.hpp"

#include "loopmark/surfels/local_map.hpp"

namespace loopmark::odometry {

void check(const OdometryOptions& o) {
  require_option(o.min_range_m >= 0.0 && o.max_range_m > o.min_range_m, "max_range_m", "must exceed min_range_m >= 0");
  require_option(o.voxel_m >= 0.0, "voxel_m", "must not be negative");
  require_option(o.points_per_voxel >= 1 && o.points_per_voxel <= surfels::LocalMap::kMaxPoints, "points_per_voxel",
                 "must be 1 to " + std::to_string(surfels::LocalMap::kMaxPoints));
  require_option(o.keypoint_voxels > 0.0, "keypoint_voxels", "must be positive");
  require_option(o.max_iterations >= 1, "max_iterations", "must be at least 1");
  require_option(o.min_threshold_m > 0.0 && o.first_threshold_m >= o.min_threshold_m, "first_threshold_m",
                 "must be at least min_threshold_m > 0");
  require_option(o.point_weight >= 0.0 && o.point_weight <= 1.0, "point_weight", "must be 0 to 1");
}

}  // namespace loopmark::odometry

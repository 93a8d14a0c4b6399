// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Tells scans that were moved into one world frame already (registered clouds of another program) from scans in the
/// sensor's frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::odometry {

/// What one stretch of scans shows.
struct FrameFinding {
  bool in_world_frame = false;
  double blind_spot_m = 0.0;  ///< median over the directions: by how much the empty space around the origin changed
  double motion_m = 0.0;      ///< from the first to the last scan, as they fit each other
};

/// Median over the directions of the change of the nearest point's horizontal distance from the origin, metres;
/// negative where too few directions hold points of both. In the sensor's frame the blind spot around the sensor stays.
double blind_spot_change(const PointCloud& before, const PointCloud& now);

/// The scans of `window` are in a world frame when they fit each other without motion, yet the space that the sensor
/// does not see lies elsewhere in the last one.
FrameFinding find_world_frame(const std::vector<std::size_t>& window, const std::function<Scan(std::size_t)>& read);

}  // namespace loopmark::odometry

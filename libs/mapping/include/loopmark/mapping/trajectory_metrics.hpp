// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// How far a trajectory is from the truth.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::mapping {

/// Absolute trajectory error after the rigid motion (no scale) that fits the estimated positions best to the true ones
/// (Horn 1987; Sturm et al., IROS 2012). Metres.
struct AbsoluteError {
  double rmse_m = 0.0;
  double median_m = 0.0;
  double max_m = 0.0;
  std::size_t poses = 0;
};

/// Both as long, at least one pose; throws std::invalid_argument otherwise.
AbsoluteError absolute_error(const std::vector<Pose>& estimate, const std::vector<Pose>& truth);

/// KITTI's odometry error (Geiger et al., CVPR 2012): over all segments of 100, 200, ..., 800 m of true path that start
/// at every tenth pose, the mean translation error in percent of the length and the mean rotation error in degrees a
/// metre.
struct KittiError {
  double translation_percent = 0.0;
  double rotation_deg_per_m = 0.0;
  std::size_t segments = 0;  ///< 0: the path is shorter than 100 m
};

KittiError kitti_error(const std::vector<Pose>& estimate, const std::vector<Pose>& truth);

/// The definitions in words, for a table's note.
std::string trajectory_error_definitions();

/// Length of the path through the positions, metres.
double path_length_m(const std::vector<Pose>& poses);

}  // namespace loopmark::mapping

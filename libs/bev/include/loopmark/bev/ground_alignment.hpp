// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Puts a scan upright: z up, the ground below the sensor at z = 0.
#pragma once

#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::bev {

struct GroundAlignment {
  Pose T_level_sensor = Pose::Identity();  ///< rotation of least angle and a shift along z; no yaw
  double ground_share = 0.0;               ///< share of the near points within 0.15 m of the plane
  bool found = false;                      ///< false: no plane was good enough; T_level_sensor only guesses the height
};

/// Finds the ground plane near the sensor (3 to 30 m, within 20 degrees of horizontal) by RANSAC with a
/// penalty for points below the plane, refined by least squares. `points` are in the sensor's frame, z
/// roughly up, already voxelised. Deterministic.
GroundAlignment find_ground_alignment(const std::vector<Eigen::Vector3f>& points);

}  // namespace loopmark::bev

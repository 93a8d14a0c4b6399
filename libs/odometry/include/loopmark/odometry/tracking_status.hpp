// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::odometry {

enum class Tracking {
  kGood,        ///< the scan fits the map and every direction is held
  kDegenerate,  ///< it fits, but a direction is hardly held (see degenerate_directions)
  kLost,        ///< it does not fit: the pose is no more than a guess
};

/// How much a pose of the odometry can be trusted, and why.
struct TrackingStatus {
  Tracking tracking = Tracking::kLost;
  std::string reason;            ///< why tracking is lost; empty otherwise
  std::size_t keypoints = 0;     ///< that were aligned
  double inlier_share = 0.0;     ///< of the keypoints, those that fit a surface of the map
  double unmapped_share = 0.0;   ///< of the keypoints, those with nothing of the map nearby: new surroundings
  bool few_fit = false;          ///< fewer fit than options ask for; believed as no other place fits nearly as well
  double fit_share = 0.0;        ///< the same, of the keypoints that have a point of the map nearby
  std::size_t structure = 0;     ///< of the keypoints, those known to be no ground; 0 where nobody told them apart
  double structure_share = 0.0;  ///< of these, those that fit
  /// Inliers against those of the best answer elsewhere around; 0: not looked for, as enough points fit.
  double margin = 0.0;
  double residual_m = 0.0;  ///< root mean square distance of the inliers across their surfaces
  std::size_t iterations = 0;
  bool converged = false;
  /// Directions of translation (unit vectors, lidar frame) that hardly any surface holds.
  std::vector<Eigen::Vector3d> degenerate_directions;
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in T_map_lidar * exp(xi); metres, radians
};

/// "good", "degenerate", "lost".
const char* name(Tracking tracking);

}  // namespace loopmark::odometry

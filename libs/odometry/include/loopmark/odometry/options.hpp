// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/core/options.hpp"

namespace loopmark::odometry {

/// What the scans of a log have gone through, as far as motion during the sweep is concerned.
enum class Compensation {
  kUnknown,              ///< not measured, or the measurement does not tell
  kCompensated,          ///< as if taken at one instant: leave them alone
  kRawGivenTimes,        ///< the sensor moved during the sweep; the log has a time for every point
  kRawClockwise,         ///< the same, without times: the sweep turns clockwise seen from above
  kRawCounterClockwise,  ///< the same, counter-clockwise
};

struct OdometryOptions {
  double min_range_m = 0.5;           ///< nearer points are dropped (the sensor's own carrier)
  double max_range_m = 100.0;         ///< farther points are dropped
  double voxel_m = 0.0;               ///< voxel of the local map; 0: from the scene's size
  std::size_t points_per_voxel = 16;  ///< points that one voxel of the local map keeps
  double keypoint_voxels = 1.5;       ///< one keypoint in a cell of this many voxels is aligned
  std::size_t max_iterations = 30;    ///< Gauss-Newton steps of one alignment
  double first_threshold_m = 1.0;     ///< distance to a match allowed before the motion model has proved itself
  double min_threshold_m = 0.3;       ///< the same, at least
  double point_weight = 0.05;         ///< weight of the distance along a plane against the one across it
  double min_inlier_share = 0.7;      ///< fewer keypoints that fit the map: tracking is lost
  double min_margin = 1.3;            ///< unless the best answer elsewhere around has this many times fewer
  double max_acceleration = 40.0;     ///< m/s2; a jump beyond it is no motion of a vehicle
  double degenerate_share = 0.02;     ///< a direction seen by a smaller share of the keypoints is degenerate
  double covariance_scale = 30.0;     ///< neighbouring points err alike: the covariance is this much larger
};

template <class Visitor>
void describe(Visitor& v, OdometryOptions& o) {
  v.field("min_range_m", o.min_range_m, "nearer points are dropped (the sensor's own carrier), metres");
  v.field("max_range_m", o.max_range_m, "farther points are dropped, metres");
  v.field("voxel_m", o.voxel_m, "voxel of the local map, metres; 0: from the scene's size");
  v.field("points_per_voxel", o.points_per_voxel, "points that one voxel of the local map keeps");
  v.field("keypoint_voxels", o.keypoint_voxels, "one keypoint in a cell of this many voxels is aligned");
  v.field("max_iterations", o.max_iterations, "Gauss-Newton steps of one alignment");
  v.field("first_threshold_m", o.first_threshold_m,
          "distance to a match before the motion model has proved itself, metres");
  v.field("min_threshold_m", o.min_threshold_m, "the same, at least, metres");
  v.field("point_weight", o.point_weight, "weight of the distance along a plane against the one across it");
  v.field("min_inlier_share", o.min_inlier_share, "fewer keypoints that fit the map: tracking is lost");
  v.field("min_margin", o.min_margin, "unless the best answer elsewhere around has this many times fewer");
  v.field("max_acceleration", o.max_acceleration, "a jump beyond it is no motion of a vehicle, m/s2");
  v.field("degenerate_share", o.degenerate_share, "a direction seen by a smaller share of the keypoints is degenerate");
  v.field("covariance_scale", o.covariance_scale, "neighbouring points err alike: the covariance is this much larger");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const OdometryOptions& options);

}  // namespace loopmark::odometry

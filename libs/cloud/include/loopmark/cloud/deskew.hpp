// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Undoing the sensor's own motion during a sweep.
#pragma once

#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::cloud {

/// How a spinning sensor sweeps: enough to tell the time of a point from its azimuth.
struct SweepModel {
  bool clockwise = true;                             ///< seen from above (+z)
  double seam_azimuth_rad = 3.14159265358979323846;  ///< where a sweep begins and ends; pi: behind, 0: in front
  double period_s = 0.1;                             ///< time of one turn
  /// Moment of the sweep that the stamp means: 0 its beginning, 0.5 its middle, 1 its end.
  double stamp_at = 0.5;
};

/// Time of each point relative to the stamp of its scan, seconds, from its azimuth atan2(y, x).
std::vector<float> times_from_azimuth(const std::vector<Eigen::Vector3f>& points, const SweepModel& sweep);

/// The same for one point.
float time_from_azimuth(const Eigen::Vector3f& point, const SweepModel& sweep);

/// Moves each point to where the sensor would have seen it at the scan's stamp: p' = exp(velocity * t) * p,
/// for a constant `velocity` ([translation; rotation] a second, in the sensor's frame) and times t (seconds
/// relative to the stamp, as many as points). Times are rounded to 1/4096 of their span.
std::vector<Eigen::Vector3f> deskewed(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<float>& time_offset_s, const Vector6d& velocity);

}  // namespace loopmark::cloud

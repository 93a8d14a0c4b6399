// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/deskew.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace loopmark::cloud {
namespace {

constexpr std::size_t kSteps = 4096;

/// Motions at evenly spread times of a sweep, so that a point costs one product and no exponential.
class MotionTable {
 public:
  MotionTable(float first_s, float last_s, const Vector6d& velocity)
      : first_s_(first_s), steps_a_second_(last_s > first_s ? kSteps / (last_s - first_s) : 0.0F) {
    rotation_.resize(kSteps + 1);
    translation_.resize(kSteps + 1);
    for (std::size_t k = 0; k <= kSteps; ++k) {
      const double time = first_s + (static_cast<double>(last_s) - first_s) * static_cast<double>(k) / kSteps;
      const Pose motion = exp_se3(time * velocity);
      rotation_[k] = motion.linear().cast<float>();
      translation_[k] = motion.translation().cast<float>();
    }
  }

  Eigen::Vector3f apply(const Eigen::Vector3f& point, float time_s) const {
    const auto k = static_cast<std::size_t>((time_s - first_s_) * steps_a_second_ + 0.5F);
    return rotation_[k] * point + translation_[k];
  }

 private:
  float first_s_;
  float steps_a_second_;
  std::vector<Eigen::Matrix3f> rotation_;
  std::vector<Eigen::Vector3f> translation_;
};

}  // namespace

float time_from_azimuth(const Eigen::Vector3f& point, const SweepModel& sweep) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double azimuth = std::atan2(static_cast<double>(point.y()), static_cast<double>(point.x()));
  double turned = (azimuth - sweep.seam_azimuth_rad) / kTurn * (sweep.clockwise ? -1.0 : 1.0);
  turned -= std::floor(turned);
  return static_cast<float>((turned - sweep.stamp_at) * sweep.period_s);
}

std::vector<float> times_from_azimuth(const std::vector<Eigen::Vector3f>& points, const SweepModel& sweep) {
  std::vector<float> times(points.size());
  std::transform(points.begin(), points.end(), times.begin(),
                 [&](const Eigen::Vector3f& point) { return time_from_azimuth(point, sweep); });
  return times;
}

std::vector<Eigen::Vector3f> deskewed(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<float>& time_offset_s, const Vector6d& velocity) {
  if (points.size() != time_offset_s.size()) {
    throw std::invalid_argument("deskewed: one time for each point is needed");
  }
  if (points.empty() || velocity.isZero(0.0)) {
    return points;
  }
  const auto [first, last] = std::minmax_element(time_offset_s.begin(), time_offset_s.end());
  const MotionTable motion(*first, *last, velocity);
  std::vector<Eigen::Vector3f> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    result[i] = motion.apply(points[i], time_offset_s[i]);
  }
  return result;
}

}  // namespace loopmark::cloud

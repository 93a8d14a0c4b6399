// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/trajectory_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopmark::mapping {
namespace {

void require_equal_lengths(const std::vector<Pose>& estimate, const std::vector<Pose>& truth) {
  if (estimate.size() != truth.size() || estimate.empty()) {
    throw std::invalid_argument("trajectory errors need as many true poses as estimated ones");
  }
}

std::vector<double> distances_driven(const std::vector<Pose>& poses) {
  std::vector<double> driven(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    driven[i] = driven[i - 1] + (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return driven;
}

}  // namespace

AbsoluteError absolute_error(const std::vector<Pose>& estimate, const std::vector<Pose>& truth) {
  require_equal_lengths(estimate, truth);
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(estimate.size()));
  Eigen::Matrix3Xd to(3, static_cast<Eigen::Index>(truth.size()));
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = estimate[i].translation();
    to.col(static_cast<Eigen::Index>(i)) = truth[i].translation();
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd left = ((fit.topLeftCorner<3, 3>() * from).colwise() + fit.topRightCorner<3, 1>()) - to;
  std::vector<double> errors(estimate.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = left.col(static_cast<Eigen::Index>(i)).norm();
  }
  std::sort(errors.begin(), errors.end());
  return {std::sqrt(left.colwise().squaredNorm().mean()), errors[errors.size() / 2], errors.back(), errors.size()};
}

KittiError kitti_error(const std::vector<Pose>& estimate, const std::vector<Pose>& truth) {
  require_equal_lengths(estimate, truth);
  constexpr std::size_t kEvery = 10;
  const std::vector<double> driven = distances_driven(truth);
  KittiError error;
  for (std::size_t first = 0; first < truth.size(); first += kEvery) {
    for (int length = 100; length <= 800; length += 100) {
      const auto end = std::upper_bound(driven.begin(), driven.end(), driven[first] + length);
      if (end == driven.end()) {
        break;
      }
      const auto last = static_cast<std::size_t>(end - driven.begin());
      const PoseError segment =
          pose_error(estimate[first].inverse() * estimate[last], truth[first].inverse() * truth[last]);
      error.translation_percent += 100.0 * segment.translation_m / length;
      error.rotation_deg_per_m += segment.rotation_deg / length;
      ++error.segments;
    }
  }
  if (error.segments > 0) {
    error.translation_percent /= static_cast<double>(error.segments);
    error.rotation_deg_per_m /= static_cast<double>(error.segments);
  }
  return error;
}

std::string trajectory_error_definitions() {
  return "ATE: root mean square distance of all scans' positions from the true ones, after the rigid motion that fits "
         "them best. t_err, r_err: mean error of relative motions over all segments of 100, 200, ..., 800 m of true "
         "path "
         "starting at every 10th scan, in percent of the length and in degrees per metre (KITTI).";
}

double path_length_m(const std::vector<Pose>& poses) { return poses.empty() ? 0.0 : distances_driven(poses).back(); }

}  // namespace loopmark::mapping

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "align_to_ground.hpp"

#include <Eigen/Cholesky>

namespace loopmark::registration::internal {
namespace {

constexpr int kRounds = 3;
constexpr double kFewest = 20.0;
constexpr double kScale = 0.3;      // metres; a surfel that gapes by so much counts a quarter
constexpr float kFarthest = 60.0F;  // metres from the target's sensor
constexpr double kMostTilt = 0.12;  // radians: steeper streets are rare, false ground is not
constexpr double kStiffness = 3e4;  // square metres: keeps the tilt small where ground is seen on one side only

}  // namespace

Pose align_to_ground(const Pose& T_target_source, const std::vector<surfels::Surfel>& source_ground,
                     const bev::GroundMap& target) {
  Pose T = T_target_source;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d h = Eigen::Vector3d(0.0, kStiffness, kStiffness).asDiagonal();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    double count = 0.0;
    const double scale = round == 0 ? 5.0 * kScale : kScale;
    for (const surfels::Surfel& surfel : source_ground) {
      const Eigen::Vector3d p = T * surfel.mean.cast<double>();
      const Eigen::Vector3f q = p.cast<float>();
      if (q.head<2>().norm() > kFarthest || !target.seen(q.x(), q.y())) {
        continue;
      }
      // z + wx y - wy x: the height of the point after a small turn (wx, wy) and a lift.
      const double gap = -static_cast<double>(target.height_above(q));
      const Eigen::Vector3d row(1.0, p.y(), -p.x());
      const double ratio = 1.0 / (1.0 + gap * gap / (scale * scale));
      h += ratio * ratio * row * row.transpose();
      g += ratio * ratio * gap * row;
      count += 1.0;
    }
    if (count < kFewest) {
      return T_target_source;
    }
    const Eigen::Vector3d x = h.ldlt().solve(g);
    if (std::hypot(x[1], x[2]) > kMostTilt) {
      return T_target_source;
    }
    Vector6d step = Vector6d::Zero();
    step[2] = x[0];
    step[3] = x[1];
    step[4] = x[2];
    T = exp_se3(step) * T;
  }
  return T;
}

}  // namespace loopmark::registration::internal

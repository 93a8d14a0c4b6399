// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "align_to_ground.hpp"

#include <cmath>
#include <optional>

#include "loopmark/least_squares/normal_equations.hpp"
#include "loopmark/least_squares/robust_kernel.hpp"

namespace loopmark::registration::internal {
namespace {

constexpr std::size_t kRounds = 3;
constexpr double kFewest = 20.0;
constexpr double kScale = 0.3;      // metres; a surfel that gapes by so much counts a quarter
constexpr float kFarthest = 60.0F;  // metres from the target's sensor
constexpr double kMostTilt = 0.12;  // radians: steeper streets are rare, false ground is not
constexpr double kStiffness = 3e4;  // square metres: keeps the tilt small where ground is seen on one side only

struct GroundEquations : least_squares::NormalEquations<3> {
  double count = 0.0;
};

/// The unknowns lift and tilt: z + wx y - wy x is the height of a point after a lift and a small turn (wx, wy).
GroundEquations linearize(const std::vector<surfels::Surfel>& source_ground, const bev::GroundMap& target,
                          const Pose& T, double scale_m) {
  GroundEquations sums;
  for (const surfels::Surfel& surfel : source_ground) {
    const Eigen::Vector3d p = T * surfel.mean.cast<double>();
    const Eigen::Vector3f q = p.cast<float>();
    if (q.head<2>().norm() > kFarthest || !target.seen(q.x(), q.y())) {
      continue;
    }
    const double height = target.height_above(q);
    sums.add_row({1.0, p.y(), -p.x()}, height,
                 least_squares::robust_weight(least_squares::RobustKernel::kGemanMcClure, height * height, scale_m));
    sums.count += 1.0;
  }
  return sums;
}

}  // namespace

Pose align_to_ground(const Pose& T_target_source, const std::vector<surfels::Surfel>& source_ground,
                     const bev::GroundMap& target) {
  Pose T = T_target_source;
  bool sensible = true;
  const auto step_at = [&](std::size_t round) -> std::optional<Eigen::Vector3d> {
    GroundEquations sums = linearize(source_ground, target, T, round == 0 ? 5.0 * kScale : kScale);
    sums.hessian.diagonal().tail<2>().array() += kStiffness;
    const Eigen::Vector3d x = sums.step();
    sensible = sums.count >= kFewest && std::hypot(x[1], x[2]) <= kMostTilt;
    return sensible ? std::optional(x) : std::nullopt;
  };
  const auto retract = [&](const Eigen::Vector3d& x) {
    Vector6d step = Vector6d::Zero();
    step.segment<3>(2) = x;
    T = exp_se3(step) * T;
  };
  least_squares::gauss_newton({kRounds, 0.0}, step_at, retract);
  return sensible ? T : T_target_source;
}

}  // namespace loopmark::registration::internal

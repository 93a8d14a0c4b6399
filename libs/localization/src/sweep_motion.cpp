// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_motion.hpp"

#include "loopmark/least_squares/normal_equations.hpp"
#include "loopmark/least_squares/robust_kernel.hpp"

namespace loopmark::localization::internal {
namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;

constexpr std::size_t kBlock = 512;  // points of one partial sum
constexpr std::size_t kSteps = 20;
constexpr auto kKernel = least_squares::RobustKernel::kGemanMcClure;
constexpr double kConverged = 1e-4;
constexpr double kLeastMatches = 50;
constexpr double kSpeedPrior = 1e-5;     // weight of (m/s)^2 a point: decides only where no surface does
constexpr double kTurnPrior = 1e-3;      // and of (rad/s)^2
constexpr double kFastest = 45.0;        // m/s
constexpr double kFastestTurn = 2.0;     // rad/s
constexpr double kFarthestMetres = 3.0;  // from the start
constexpr double kFarthestDegrees = 10.0;

struct Sums : least_squares::NormalEquations<12> {
  double matches = 0.0;

  Sums& operator+=(const Sums& other) {
    NormalEquations<12>::operator+=(other);
    matches += other.matches;
    return *this;
  }
};

Sums linearize(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& times,
               const surfels::LocalMap& map, const SweepInMap& at, double threshold_m) {
  const double scale = 0.5 * threshold_m;
  return least_squares::sum_in_blocks<Sums>(points.size(), kBlock, [&](std::size_t i, Sums& sums) {
    const double t = times[i];
    const Eigen::Vector3d seen = exp_se3(t * at.velocity) * points[i].cast<double>();
    const Eigen::Vector3d point = at.T_map_lidar * seen;
    surfels::MapMatch match;
    if (!map.nearest(point, threshold_m, match) || match.normal.isZero(0.0)) {
      return;
    }
    const double across = match.normal.dot(point - match.point);
    const Eigen::Vector3d n = at.T_map_lidar.linear().transpose() * match.normal;  // in the lidar's frame
    Vector12d j;
    j.head<6>() << n, seen.cross(n);
    j.tail<6>() = t * j.head<6>();
    sums.add_row(j, across, least_squares::robust_weight(kKernel, across * across, scale));
    sums.matches += 1.0;
  });
}

}  // namespace

std::optional<SweepInMap> align_sweep(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& times,
                                      const surfels::LocalMap& map, const Pose& start) {
  SweepInMap at{start, Vector6d::Zero()};
  bool enough = true;
  const auto step_at = [&](std::size_t iteration) -> std::optional<Vector12d> {
    const double threshold_m = map.voxel_m() * (iteration < kSteps / 2 ? 1.0 : 0.5);
    Sums sums = linearize(points, times, map, at, threshold_m);
    enough = sums.matches >= kLeastMatches;
    if (!enough) {
      return std::nullopt;
    }
    sums.hessian.diagonal().head<6>().array() += 1e-6 * sums.matches;
    least_squares::add_prior(sums, 6, at.velocity.head<3>().eval(), sums.matches * kSpeedPrior);
    least_squares::add_prior(sums, 9, at.velocity.tail<3>().eval(), sums.matches * kTurnPrior);
    return sums.step();
  };
  const auto retract = [&](const Vector12d& change) {
    at.T_map_lidar = at.T_map_lidar * exp_se3(change.head<6>());
    at.velocity += change.tail<6>();
  };
  least_squares::gauss_newton(kSteps, step_at, retract, [](const Vector12d& change, std::size_t iteration) {
    return iteration > kSteps / 2 && change.head<6>().norm() < kConverged;
  });
  if (!enough) {
    return std::nullopt;
  }
  const PoseError moved = pose_error(at.T_map_lidar, start);
  const bool sensible = moved.translation_m < kFarthestMetres && moved.rotation_deg < kFarthestDegrees &&
                        at.velocity.head<3>().norm() < kFastest && at.velocity.tail<3>().norm() < kFastestTurn;
  return sensible ? std::optional(at) : std::nullopt;
}

}  // namespace loopmark::localization::internal

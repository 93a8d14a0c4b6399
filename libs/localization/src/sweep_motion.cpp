// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "loopmark/core/parallel.hpp"

namespace loopmark::localization::internal {
namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

constexpr std::size_t kBlock = 512;  // points of one partial sum
constexpr int kSteps = 20;
constexpr double kConverged = 1e-4;
constexpr double kLeastMatches = 50;
constexpr double kSpeedPrior = 1e-5;     // weight of (m/s)^2 a point: decides only where no surface does
constexpr double kTurnPrior = 1e-3;      // and of (rad/s)^2
constexpr double kFastest = 45.0;        // m/s
constexpr double kFastestTurn = 2.0;     // rad/s
constexpr double kFarthestMetres = 3.0;  // from the start
constexpr double kFarthestDegrees = 10.0;

struct Sums {
  Matrix12d H = Matrix12d::Zero();
  Vector12d b = Vector12d::Zero();
  double matches = 0.0;

  Sums& operator+=(const Sums& other) {
    H += other.H;
    b += other.b;
    matches += other.matches;
    return *this;
  }
};

Sums linearize(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& times,
               const odometry::LocalMap& map, const SweepInMap& at, double threshold_m) {
  const double scale = 0.5 * threshold_m;
  const auto map_block = [&](std::size_t begin, std::size_t end) {
    Sums sums;
    odometry::MapMatch match;
    for (std::size_t i = begin; i < end; ++i) {
      const double t = times[i];
      const Eigen::Vector3d seen = exp_se3(t * at.velocity) * points[i].cast<double>();
      const Eigen::Vector3d point = at.T_map_lidar * seen;
      if (!map.nearest(point, threshold_m, match) || match.normal.isZero(0.0)) {
        continue;
      }
      const double across = match.normal.dot(match.point - point);
      const double share = scale * scale / (scale * scale + across * across);
      const Eigen::Vector3d n = at.T_map_lidar.linear().transpose() * match.normal;  // in the lidar's frame
      Vector12d j;
      j.head<6>() << n, seen.cross(n);
      j.tail<6>() = t * j.head<6>();
      sums.H.noalias() += share * share * j * j.transpose();
      sums.b.noalias() += share * share * across * j;
      sums.matches += 1.0;
    }
    return sums;
  };
  return parallel_reduce_ordered(points.size(), kBlock, Sums{}, map_block, [](Sums& a, const Sums& b) { a += b; });
}

}  // namespace

std::optional<SweepInMap> align_sweep(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& times,
                                      const odometry::LocalMap& map, const Pose& start) {
  SweepInMap at{start, Vector6d::Zero()};
  Vector6d prior;
  prior << Eigen::Vector3d::Constant(kSpeedPrior), Eigen::Vector3d::Constant(kTurnPrior);
  for (int step = 0; step < kSteps; ++step) {
    const double threshold_m = map.voxel_m() * (step < kSteps / 2 ? 1.0 : 0.5);
    Sums sums = linearize(points, times, map, at, threshold_m);
    if (sums.matches < kLeastMatches) {
      return std::nullopt;
    }
    sums.H.diagonal().head<6>().array() += 1e-6 * sums.matches;
    sums.H.diagonal().tail<6>() += sums.matches * prior;
    sums.b.tail<6>() -= sums.matches * prior.cwiseProduct(at.velocity);
    const Vector12d change = sums.H.ldlt().solve(sums.b);
    at.T_map_lidar = at.T_map_lidar * exp_se3(change.head<6>());
    at.velocity += change.tail<6>();
    if (step > kSteps / 2 && change.head<6>().norm() < kConverged) {
      break;
    }
  }
  const PoseError moved = pose_error(at.T_map_lidar, start);
  const bool sensible = moved.translation_m < kFarthestMetres && moved.rotation_deg < kFarthestDegrees &&
                        at.velocity.head<3>().norm() < kFastest && at.velocity.tail<3>().norm() < kFastestTurn;
  return sensible ? std::optional(at) : std::nullopt;
}

}  // namespace loopmark::localization::internal

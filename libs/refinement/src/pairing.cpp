// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pairing.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/parallel.hpp"

namespace loopmark::refinement::internal {
namespace {

constexpr std::size_t kBlock = 1024;
/// Symmetric ICP leaves out pairs whose normals are more than 60 degrees apart: they are of different surfaces.
constexpr double kLeastNormalCosine = 0.5;

/// Upper bound of the squared search distance from the pair found in the iteration before.
float bound_from(const search::CellGrid& grid, const Eigen::Vector3f& moved, std::uint32_t place, float max_squared) {
  if (place == kUnpaired) {
    return max_squared;
  }
  const float now = (grid.point(place) - moved).squaredNorm();
  return std::min(max_squared, now * 1.0001F + 1e-12F);
}

/// Leaves out pairs whose target point is nearer to another source point.
void keep_best_buddies(const IcpTarget& target, Pairs& pairs, const IcpOptions& options) {
  const search::CellGrid sources(pairs.moved, static_cast<float>(2.0 * options.max_distance_m));
  const float max_squared = static_cast<float>(options.max_distance_m * options.max_distance_m);
  parallel_for(
      pairs.place.size(),
      [&](std::size_t i) {
        if (pairs.place[i] == kUnpaired) {
          return;
        }
        const auto back = sources.nearest(target.grid().point(pairs.place[i]), max_squared);
        if (!back || sources.index()[back->place] != i) {
          pairs.place[i] = kUnpaired;
        }
      },
      kBlock);
}

/// Information of a Generalized-ICP pair: (C_target + R C_source R^T)^-1 with C = I - (1 - epsilon) n n^T, the
/// covariance of a point that is sure along the normal and free in the plane, both scaled by epsilon.
Eigen::Matrix3d plane_to_plane(const Eigen::Vector3d& target_normal, const Eigen::Vector3d& source_normal) {
  constexpr double kEpsilon = 1e-3;
  const Eigen::Matrix3d sum =
      2.0 * Eigen::Matrix3d::Identity() -
      (1.0 - kEpsilon) * (target_normal * target_normal.transpose() + source_normal * source_normal.transpose());
  // Two equal normals leave 2 epsilon along them; the factor makes that a unit of information.
  return 2.0 * kEpsilon * sum.inverse();
}

}  // namespace

void find_pairs(const Surface& source, const IcpTarget& target, const Pose& T_target_source, const IcpOptions& options,
                Pairs& pairs) {
  const std::size_t count = source.points.size();
  pairs.moved.resize(count);
  pairs.place.resize(count, kUnpaired);
  const Eigen::Matrix3f R = T_target_source.linear().cast<float>();
  const Eigen::Vector3f t = T_target_source.translation().cast<float>();
  const float max_squared = static_cast<float>(options.max_distance_m * options.max_distance_m);
  parallel_for(
      count,
      [&](std::size_t i) {
        const Eigen::Vector3f moved = R * source.points[i] + t;
        pairs.moved[i] = moved;
        const float bound = bound_from(target.grid(), moved, pairs.place[i], max_squared);
        const auto found = target.grid().nearest(moved, bound);
        pairs.place[i] = found ? found->place : kUnpaired;
      },
      kBlock);
  if (options.pairing == IcpPairing::kBestBuddies) {
    keep_best_buddies(target, pairs, options);
  }
}

least_squares::PairEquations linearise(const Surface& source, const IcpTarget& target, const Pose& T_target_source,
                                       const Eigen::Vector3d& centre, IcpMetric metric, const IcpOptions& options,
                                       const Pairs& pairs) {
  const Eigen::Matrix3d R = T_target_source.linear();
  const auto weigh = [&](double r2) {
    return least_squares::robust_weight(options.kernel, r2, options.kernel_scale_m);
  };
  const auto add = [&](least_squares::PairEquations& sums, std::size_t i) {
    const Eigen::Vector3d moved = T_target_source * source.points[i].cast<double>() - centre;
    const Eigen::Vector3d found = target.grid().point(pairs.place[i]).cast<double>() - centre;
    const Eigen::Vector3d residual = moved - found;
    if (metric == IcpMetric::kPointToPoint) {
      sums.add_point(moved, residual, weigh(residual.squaredNorm()));
      return;
    }
    const Eigen::Vector3d normal = target.normal(pairs.place[i]).cast<double>();
    if (metric == IcpMetric::kPointToPlane) {
      const double distance = normal.dot(residual);
      sums.add_plane(moved, normal, distance, weigh(distance * distance));
      return;
    }
    Eigen::Vector3d own = R * source.normals[i].cast<double>();
    if (metric == IcpMetric::kSymmetric) {
      const double cosine = own.dot(normal);
      if (std::abs(cosine) < kLeastNormalCosine) {
        return;
      }
      own = cosine < 0.0 ? Eigen::Vector3d(-own) : own;
      const Eigen::Vector3d both = (normal + own).normalized();
      const double distance = both.dot(residual);
      sums.add_plane(0.5 * (moved + found), both, distance, weigh(distance * distance));
      return;
    }
    const Eigen::Matrix3d information = plane_to_plane(normal, own);
    sums.add_general(moved, residual, information, weigh(residual.dot(information * residual)));
  };
  return least_squares::sum_in_blocks<least_squares::PairEquations>(
      pairs.place.size(), kBlock, [&](std::size_t i, least_squares::PairEquations& sums) {
        if (pairs.place[i] != kUnpaired) {
          add(sums, i);
        }
      });
}

}  // namespace loopmark::refinement::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "loopmark/least_squares/factors.hpp"
#include "loopmark/least_squares/robust_kernel.hpp"

namespace loopmark::registration::internal {
namespace {

constexpr double kAcross = 0.05;     // weight of the residual inside a plane
constexpr double kUpright = 0.1;     // of that, what counts along the vertical
constexpr double kConverged = 1e-4;  // metres and radians
constexpr double kDamping = 1e-3;
constexpr std::size_t kFewest = 20;   // surfels with a partner
constexpr std::size_t kBlock = 2048;  // surfels of one partial sum

struct SurfelEquations : least_squares::NormalEquations<6> {
  double squares = 0.0;
  double weights = 0.0;
  std::size_t used = 0;

  SurfelEquations& operator+=(const SurfelEquations& other) {
    NormalEquations<6>::operator+=(other);
    squares += other.squares;
    weights += other.weights;
    used += other.used;
    return *this;
  }
};

/// Adds one pair: p of the source (moved), q of the target, and the one of both that is the surface, with its normal in
/// the target's frame. Weight matrix W = a diag(1, 1, u) + (1 - a) planarity n n^T.
void add_pair(SurfelEquations& sum, const Eigen::Vector3f& p, const Eigen::Vector3f& q, const surfels::Surfel& surface,
              const Eigen::Vector3f& normal, double scale_m) {
  const Eigen::Vector3d point = p.cast<double>();
  const Eigen::Vector3d n = normal.cast<double>();
  const Eigen::Vector3d residual = point - q.cast<double>();
  const double blob = 1.0 - surface.planarity;
  // Ground would only brake: the nearest surfel of a plane is near wherever one stands.
  const double across = surface.height < kGroundHeight ? 0.0 : kAcross + (1.0 - kAcross) * blob * blob * 0.5;
  // A lone ring on a wall is a line: its normal is anyone's guess, and its height is the sensor's, not the wall's.
  const Eigen::Matrix3d w = across * Eigen::Vector3d(1.0, 1.0, kUpright).asDiagonal().toDenseMatrix() +
                            (1.0 - across) * static_cast<double>(surface.planarity) * n * n.transpose();
  const double squared = residual.dot(w * residual);
  const double robust = least_squares::robust_weight(least_squares::RobustKernel::kGemanMcClure, squared, scale_m);
  least_squares::add_generalized(sum, point, residual, w, robust);
  sum.squares += robust * squared;
  sum.weights += robust;
  ++sum.used;
}

/// Of the source's surfels that have a partner within reach in the target.
SurfelEquations equations(const std::vector<surfels::Surfel>& source, const surfels::SurfelMap& target,
                          const Eigen::Isometry3f& T, float reach_m, double scale_m) {
  return least_squares::sum_in_blocks<SurfelEquations>(source.size(), kBlock, [&](std::size_t i, SurfelEquations& sum) {
    const Eigen::Vector3f p = T * source[i].mean;
    if (const surfels::Surfel* partner = target.nearest(p, reach_m)) {
      add_pair(sum, p, partner->mean, *partner, partner->normal, scale_m);
    }
  });
}

/// Of the target's surfels that have a partner within reach in the source.
SurfelEquations equations_back(const surfels::SurfelMap& source, const std::vector<surfels::Surfel>& target,
                               const Eigen::Isometry3f& T, float reach_m, double scale_m) {
  const Eigen::Isometry3f back = T.inverse();
  return least_squares::sum_in_blocks<SurfelEquations>(target.size(), kBlock, [&](std::size_t i, SurfelEquations& sum) {
    if (const surfels::Surfel* partner = source.nearest(back * target[i].mean, reach_m)) {
      add_pair(sum, T * partner->mean, target[i].mean, *partner, T.linear() * partner->normal, scale_m);
    }
  });
}

template <class Equations>
Alignment solve(const Equations& equations_at, const Pose& start, int iterations) {
  Alignment result;
  result.T_target_source = start;
  const auto step_at = [&](std::size_t) -> std::optional<Vector6d> {
    const SurfelEquations sum = equations_at(result.T_target_source.cast<float>());
    result.used = sum.used;
    result.information = sum.hessian;
    result.residual_m = sum.weights > 0.0 ? std::sqrt(sum.squares / sum.weights) : 0.0;
    return sum.used < kFewest ? std::nullopt : std::optional(sum.step(kDamping));
  };
  least_squares::gauss_newton({static_cast<std::size_t>(iterations), kConverged}, step_at, [&](const Vector6d& step) {
    result.T_target_source = exp_se3(step) * result.T_target_source;
  });
  return result;
}

}  // namespace

Alignment align_surfels(const std::vector<surfels::Surfel>& source, const surfels::SurfelMap& target, const Pose& start,
                        float reach_m, double scale_m, int iterations) {
  return solve([&](const Eigen::Isometry3f& T) { return equations(source, target, T, reach_m, scale_m); }, start,
               iterations);
}

Alignment align_both_ways(const surfels::SurfelMap& source, const surfels::SurfelMap& target, const Pose& start,
                          float reach_m, double scale_m, int iterations) {
  return solve(
      [&](const Eigen::Isometry3f& T) {
        SurfelEquations sum = equations(source.surfels(), target, T, reach_m, scale_m);
        sum += equations_back(source, target.surfels(), T, reach_m, scale_m);
        return sum;
      },
      start, iterations);
}

namespace {

/// Appends `count` surfels of `from` (at most all) at even steps.
void take_evenly(const std::vector<const surfels::Surfel*>& from, std::size_t count, std::vector<surfels::Surfel>& to) {
  count = std::min(count, from.size());
  for (std::size_t i = 0; i < count; ++i) {
    to.push_back(*from[i * from.size() / count]);
  }
}

template <class Belongs>
std::vector<surfels::Surfel> sampled_where(const std::vector<surfels::Surfel>& surfels, std::size_t count,
                                           Belongs belongs) {
  std::vector<const surfels::Surfel*> fitting;
  for (const surfels::Surfel& surfel : surfels) {
    if (belongs(surfel)) {
      fitting.push_back(&surfel);
    }
  }
  std::vector<surfels::Surfel> chosen;
  take_evenly(fitting, count, chosen);
  return chosen;
}

}  // namespace

std::vector<surfels::Surfel> sampled(const std::vector<surfels::Surfel>& surfels, std::size_t count) {
  std::vector<const surfels::Surfel*> structure;
  std::vector<const surfels::Surfel*> ground;
  for (const surfels::Surfel& surfel : surfels) {
    (surfel.height > kStructureHeight ? structure : ground).push_back(&surfel);
  }
  std::vector<surfels::Surfel> chosen;
  take_evenly(structure, std::max(count / 2, count - std::min(count, ground.size())), chosen);
  take_evenly(ground, count - chosen.size(), chosen);
  return chosen;
}

std::vector<surfels::Surfel> sampled_structure(const std::vector<surfels::Surfel>& surfels, std::size_t count) {
  return sampled_where(surfels, count, [](const surfels::Surfel& surfel) { return surfel.height > kStructureHeight; });
}

std::vector<surfels::Surfel> sampled_ground(const std::vector<surfels::Surfel>& surfels, std::size_t count) {
  return sampled_where(surfels, count, [](const surfels::Surfel& surfel) { return surfel.height < kGroundHeight; });
}

}  // namespace loopmark::registration::internal

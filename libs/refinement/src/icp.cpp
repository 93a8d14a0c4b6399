// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/refinement/icp.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "loopmark/core/number_text.hpp"
#include "pairing.hpp"

namespace loopmark::refinement {
namespace {

using internal::find_pairs;
using internal::linearise;
using internal::Pairs;

void require_normals(const Surface& source, const IcpTarget& target, IcpMetric metric) {
  const bool of_target = metric != IcpMetric::kPointToPoint;
  const bool of_source = metric == IcpMetric::kSymmetric || metric == IcpMetric::kGeneralized;
  if (of_target && !target.has_normals() && target.grid().size() > 0) {
    throw std::invalid_argument("icp: this metric needs normals of the target");
  }
  if (of_source && source.normals.size() != source.points.size()) {
    throw std::invalid_argument("icp: this metric needs normals of the source");
  }
}

Eigen::Vector3d centre_of(const Surface& source, const Pose& T_target_source) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : source.points) {
    sum += p.cast<double>();
  }
  return T_target_source * (sum / static_cast<double>(std::max<std::size_t>(1, source.points.size()))).eval();
}

bool is_small(const Vector6d& xi, const IcpOptions& options) {
  constexpr double kDegree = M_PI / 180.0;
  return xi.head<3>().norm() < options.stop_translation_m && xi.tail<3>().norm() < options.stop_rotation_deg * kDegree;
}

/// Inliers, residual, information and weak directions at the final motion.
void judge(const Surface& source, const IcpTarget& target, const IcpOptions& options, const Eigen::Vector3d& centre,
           IcpResult& result, internal::Pairs& pairs) {
  internal::find_pairs(source, target, result.T_target_source, options, pairs);
  const least_squares::PairEquations sums =
      internal::linearise(source, target, result.T_target_source, centre, options.metric, options, pairs);
  result.inliers = sums.pairs;
  result.inlier_share =
      static_cast<double>(sums.pairs) / static_cast<double>(std::max<std::size_t>(1, source.points.size()));
  if (!(sums.weight > 0.0)) {
    result.covariance = least_squares::uncertainty_of(sums, 1.0).covariance;
    return;
  }
  const double freedom = std::max(1.0, static_cast<double>(sums.residuals) - 6.0);
  const double mean_weight = sums.weight / static_cast<double>(sums.pairs);
  const double variance = sums.cost / (freedom * mean_weight);
  result.rms_m = std::sqrt(sums.cost / sums.weight);
  const double floor = options.noise_floor_m * options.noise_floor_m;
  const least_squares::Uncertainty uncertainty =
      least_squares::about_origin(least_squares::uncertainty_of(sums, std::max(variance, floor)), centre);
  result.information = uncertainty.information;
  result.covariance = uncertainty.covariance;
  const bool plane = target.has_normals();
  result.constraint =
      least_squares::constraint_of(plane ? internal::linearise(source, target, result.T_target_source, centre,
                                                               IcpMetric::kPointToPlane, options, pairs)
                                         : sums);
  result.weak_directions = result.constraint.weak(options.weak_strength);
}

}  // namespace

IcpTarget::IcpTarget(const Surface& surface, double max_distance_m)
    : grid_(surface.points, static_cast<float>(2.0 * max_distance_m)) {
  if (surface.normals.empty()) {
    return;
  }
  if (surface.normals.size() != surface.points.size()) {
    throw std::invalid_argument("IcpTarget: as many normals as points are needed");
  }
  normals_.reserve(grid_.size());
  for (const std::uint32_t i : grid_.index()) {
    normals_.push_back(surface.normals[i]);
  }
}

const char* to_string(IcpStop stop) {
  switch (stop) {
    case IcpStop::kConverged:
      return "converged";
    case IcpStop::kIterationLimit:
      return "iteration limit";
    case IcpStop::kTooFewPairs:
      return "too few pairs";
  }
  return "";
}

std::string IcpResult::summary() const {
  return format_text("%s after %zu iterations: %zu pairs (%.1f %% of the source), rms %.3f m, %d weak", to_string(stop),
                     iterations, inliers, 100.0 * inlier_share, rms_m, weak_directions);
}

IcpResult icp(const Surface& source, const IcpTarget& target, const Pose& initial, const IcpOptions& options) {
  check(options);
  require_normals(source, target, options.metric);
  IcpResult result;
  result.T_target_source = initial;
  const Eigen::Vector3d centre = centre_of(source, initial);
  internal::Pairs pairs;
  while (result.iterations < options.max_iterations) {
    internal::find_pairs(source, target, result.T_target_source, options, pairs);
    const least_squares::PairEquations sums =
        internal::linearise(source, target, result.T_target_source, centre, options.metric, options, pairs);
    if (sums.pairs < std::max<std::size_t>(3, options.min_pairs)) {
      result.stop = IcpStop::kTooFewPairs;
      break;
    }
    const Vector6d xi = least_squares::gauss_newton_step(sums);
    result.T_target_source = least_squares::move_about(centre, xi) * result.T_target_source;
    ++result.iterations;
    if (is_small(xi, options)) {
      result.stop = IcpStop::kConverged;
      result.converged = true;
      break;
    }
  }
  // Products of many small steps drift from orthonormal by rounding.
  result.T_target_source = rigid_from_matrix(result.T_target_source.matrix());
  judge(source, target, options, centre, result, pairs);
  return result;
}

}  // namespace loopmark::refinement

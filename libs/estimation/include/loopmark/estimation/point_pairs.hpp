// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/matching/correspondence.hpp"

namespace loopmark::estimation {

/// Matched points (metres), side by side, the best match first: what every estimator works on.
struct PointPairs {
  std::vector<Eigen::Vector3f> source;
  std::vector<Eigen::Vector3f> target;

  std::size_t size() const { return source.size(); }

  /// The points of the matches, in their order. Throws std::out_of_range when a match names no point.
  static PointPairs of(const matching::Correspondences& matches, const std::vector<Eigen::Vector3f>& source,
                       const std::vector<Eigen::Vector3f>& target);
};

/// The rigid motion T_target_source with the least weighted squared distance over the pairs at `indices` (Kabsch 1976,
/// Umeyama 1991). Empty weights: all 1. Identity for fewer than one pair.
Pose fit_rigid(const PointPairs& pairs, const std::vector<std::size_t>& indices,
               const std::vector<double>& weights = {});

/// Squared residual |T p - q|^2 of one pair.
double squared_residual(const PointPairs& pairs, std::size_t i, const Pose& T_target_source);

/// Pairs whose residual is below `threshold_m`, ascending.
std::vector<std::size_t> inliers_of(const PointPairs& pairs, const Pose& T_target_source, double threshold_m);

/// Reweighted least squares with weights (1 - r^2/t^2)^2 from a motion that is roughly right (the final step of the
/// paper's RANSAC); gives the motion back unchanged when fewer than 3 pairs are within `threshold_m`.
Pose reweighted_fit(const PointPairs& pairs, const Pose& initial, double threshold_m, int iterations = 10);

}  // namespace loopmark::estimation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/estimation/ransac.hpp"
#include "scorer.hpp"

namespace loopmark::estimation::internal {

/// Improves a new best motion by least squares on samples of its inliers (LO-RANSAC), the inliers being those
/// below the threshold or those of a graph cut with spatial coherence (GC-RANSAC).
class LocalOptimizer {
 public:
  LocalOptimizer(const PointPairs& pairs, const Scorer& scorer, const RansacOptions& options);

  /// Replaces motion and score by better ones while rounds are left.
  void improve(Pose& T, double& score, Rng& rng);

 private:
  std::vector<std::size_t> select_inliers(const Pose& T) const;
  std::vector<std::size_t> cut_inliers(const Pose& T) const;
  bool round(const std::vector<std::size_t>& inliers, Pose& T, double& score, Rng& rng) const;

  const PointPairs& pairs_;
  const Scorer& scorer_;
  const RansacOptions& options_;
  std::vector<std::pair<std::size_t, std::size_t>> neighbours_;  ///< for the graph cut only
  std::size_t rounds_ = 0;
};

}  // namespace loopmark::estimation::internal

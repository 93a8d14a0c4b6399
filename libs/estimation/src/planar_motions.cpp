// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/planar_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loopmark/core/parallel.hpp"
#include "scorer.hpp"

namespace loopmark::estimation {

void check(const PlanarMotionOptions& o) {
  require_option(o.threshold_m > 0, "threshold_m", "must be larger than 0");
  require_option(o.score_factor > 0, "score_factor", "must be larger than 0");
  require_option(o.min_edge_m > 0, "min_edge_m", "must be larger than 0");
  require_option(o.edge_tolerance_m > 0, "edge_tolerance_m", "must be larger than 0");
}

namespace {

constexpr int kRefits = 4;
constexpr std::size_t kScoredTogether = 64;

PointPairs best_of(const PointPairs& pairs, std::size_t most) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(pairs.size(), most));
  return {{pairs.source.begin(), pairs.source.begin() + count}, {pairs.target.begin(), pairs.target.begin() + count}};
}

Pose pose_of(const PlanarMotion& motion) { return pose_from_yaw(motion.yaw, motion.t); }

Eigen::Vector2d flat(const Eigen::Vector3f& p) { return p.head<2>().cast<double>(); }

/// Takes the middle of the source points onto that of the target points.
PlanarMotion align_inverse(double yaw, const Eigen::Vector3d& source, const Eigen::Vector3d& target) {
  PlanarMotion motion;
  motion.yaw = yaw;
  motion.t = target - Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * source;
  return motion;
}

/// The motions of the minimal sets that pass the check of their edge, in PROSAC's order.
std::vector<PlanarMotion> models_of(const PointPairs& pairs, const PlanarMotionOptions& o) {
  std::vector<PlanarMotion> models;
  for (std::size_t j = 1; j < pairs.size(); ++j) {
    for (std::size_t i = 0; i < j && models.size() < o.max_models; ++i) {
      const Eigen::Vector2d a = flat(pairs.source[j]) - flat(pairs.source[i]);
      const Eigen::Vector2d b = flat(pairs.target[j]) - flat(pairs.target[i]);
      const double length = a.norm();
      if (length < o.min_edge_m || std::abs(length - b.norm()) > o.edge_tolerance_m) {
        continue;
      }
      const Eigen::Vector3d source = 0.5 * (pairs.source[i] + pairs.source[j]).cast<double>();
      const Eigen::Vector3d target = 0.5 * (pairs.target[i] + pairs.target[j]).cast<double>();
      models.push_back(align_inverse(std::atan2(b.y(), b.x()) - std::atan2(a.y(), a.x()), source, target));
    }
  }
  return models;
}

/// The least-squares motion over the inliers of another; that other where there are fewer than two.
PlanarMotion refitted(const PlanarMotion& motion, const PointPairs& pairs, double threshold_m) {
  const std::vector<std::size_t> inliers = inliers_of(pairs, pose_of(motion), threshold_m);
  if (inliers.size() < 2) {
    return motion;
  }
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  for (const std::size_t i : inliers) {
    source += pairs.source[i].cast<double>();
    target += pairs.target[i].cast<double>();
  }
  source /= static_cast<double>(inliers.size());
  target /= static_cast<double>(inliers.size());
  double along = 0.0;
  double across = 0.0;
  for (const std::size_t i : inliers) {
    const Eigen::Vector2d a = flat(pairs.source[i]) - source.head<2>();
    const Eigen::Vector2d b = flat(pairs.target[i]) - target.head<2>();
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  return align_inverse(std::atan2(across, along), source, target);
}

bool alike(const PlanarMotion& a, const PlanarMotion& b, const PlanarMotionOptions& o) {
  const double turn = std::remainder(a.yaw - b.yaw, 2.0 * std::numbers::pi);
  return (a.t - b.t).head<2>().norm() < o.distinct_m && std::abs(turn) < o.distinct_deg * std::numbers::pi / 180.0;
}

std::vector<PlanarMotion> best_distinct(std::vector<PlanarMotion> motions, const PlanarMotionOptions& o) {
  std::stable_sort(motions.begin(), motions.end(),
                   [](const PlanarMotion& a, const PlanarMotion& b) { return a.score > b.score; });
  std::vector<PlanarMotion> kept;
  for (const PlanarMotion& motion : motions) {
    const bool known =
        std::any_of(kept.begin(), kept.end(), [&](const PlanarMotion& k) { return alike(motion, k, o); });
    if (!known && kept.size() < o.motions) {
      kept.push_back(motion);
    }
  }
  return kept;
}

}  // namespace

std::vector<PlanarMotion> find_planar_motions(const PointPairs& all, const PlanarMotionOptions& options) {
  check(options);
  const PointPairs pairs = best_of(all, options.max_matches);
  std::vector<PlanarMotion> motions = models_of(pairs, options);
  if (motions.empty()) {
    return motions;
  }
  const internal::Scorer scorer(pairs, options.threshold_m * options.score_factor);
  parallel_for(
      motions.size(), [&](std::size_t i) { motions[i].score = scorer.score(pose_of(motions[i]), 0.0); },
      kScoredTogether);
  motions = best_distinct(std::move(motions), options);
  for (PlanarMotion& motion : motions) {
    for (int round = 0; round < kRefits; ++round) {
      PlanarMotion better = refitted(motion, pairs, options.threshold_m);
      better.score = scorer.score(pose_of(better), 0.0);
      if (better.score <= motion.score) {
        break;
      }
      motion = better;
    }
    motion.inliers = inliers_of(pairs, pose_of(motion), options.threshold_m).size();
  }
  return best_distinct(std::move(motions), options);
}

}  // namespace loopmark::estimation

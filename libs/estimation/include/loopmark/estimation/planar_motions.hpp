// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::estimation {

/// RANSAC for scans that stand upright: two matches make a minimal set of yaw and a translation.
struct PlanarMotionOptions {
  double threshold_m = 0.6;       ///< inliers are closer than this
  double score_factor = 1.5;      ///< the score (MSAC) is truncated at this many thresholds
  double min_edge_m = 4.0;        ///< shorter minimal sets tell too little of the yaw
  double edge_tolerance_m = 0.6;  ///< edges of a minimal set differ by no more than this between the scans
  std::size_t max_matches = 500;  ///< the best of the matches
  std::size_t max_models = 3000;  ///< motions that are scored
  std::size_t motions = 16;       ///< distinct motions that are returned
  double distinct_m = 2.0;        ///< motions nearer than this ...
  double distinct_deg = 5.0;      ///< ... and turned by less than this are one
};

template <class Visitor>
void describe(Visitor& v, PlanarMotionOptions& o) {
  v.field("threshold_m", o.threshold_m, "inliers are closer than this, metres");
  v.field("score_factor", o.score_factor, "the score (MSAC) is truncated at this many thresholds");
  v.field("min_edge_m", o.min_edge_m, "two matches of a minimal set are farther apart than this, metres");
  v.field("edge_tolerance_m", o.edge_tolerance_m, "and as far apart in both scans, give or take this, metres");
  v.field("max_matches", o.max_matches, "the best of the matches that are used");
  v.field("max_models", o.max_models, "motions that are scored at most");
  v.field("motions", o.motions, "distinct motions that are returned at most");
  v.field("distinct_m", o.distinct_m, "motions nearer than this, metres, and ...");
  v.field("distinct_deg", o.distinct_deg, "... turned by less than this, degrees, are one");
}

void check(const PlanarMotionOptions& options);

/// Source points turned by yaw (radians) and moved by t (metres) fall onto target points.
struct PlanarMotion {
  double yaw = 0.0;
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double score = 0.0;  ///< sum over the matches of max(0, 1 - (residual / truncation)^2)
  std::size_t inliers = 0;
};

/// The distinct motions that most matches agree with, best first. `pairs`: in the order of quality, both scans upright
/// (z up). Minimal sets are taken in PROSAC's order without chance: all pairs of the two best matches, then those with
/// the third, and so on, rejected by the length of their edge; each motion that is returned is refitted to its inliers.
std::vector<PlanarMotion> find_planar_motions(const PointPairs& pairs, const PlanarMotionOptions& options = {});

}  // namespace loopmark::estimation

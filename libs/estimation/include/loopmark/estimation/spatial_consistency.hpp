// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/core/options.hpp"
#include "loopmark/estimation/estimate.hpp"
#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::estimation {

/// Second-order spatial consistency: the core of PointDSC (Bai et al. 2021) without what is learned, as in SC2-PCR
/// (Chen et al. 2022).
struct SpatialConsistencyOptions {
  double tolerance_m = 0.6;
  std::size_t seeds = 200;
  std::size_t neighbours = 20;
  double seed_distance_m = 1.0;
  std::size_t max_matches = 3000;
  double threshold_m = 0.6;
  double score_factor = 1.5;
};

template <class Visitor>
void describe(Visitor& v, SpatialConsistencyOptions& o) {
  v.field("tolerance_m", o.tolerance_m, "matches are consistent when their distances differ by less, metres");
  v.field("seeds", o.seeds, "matches around which a motion is estimated");
  v.field("neighbours", o.neighbours, "most consistent matches used with each of them");
  v.field("seed_distance_m", o.seed_distance_m, "seeds are at least this far apart in the source, metres");
  v.field("max_matches", o.max_matches, "only the best matches are used: the graph grows with their square");
  v.field("threshold_m", o.threshold_m, "inliers are closer than this, metres");
  v.field("score_factor", o.score_factor, "the score (MSAC) is truncated at this many thresholds");
}

void check(const SpatialConsistencyOptions& options);

/// Estimates a motion around each of many reliable matches from those that share most consistent matches with it, and
/// keeps the one that most matches agree with. Deterministic.
Estimate spatial_consistency(const PointPairs& pairs, const SpatialConsistencyOptions& options = {});

}  // namespace loopmark::estimation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/estimation/estimate.hpp"
#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::estimation {

/// What is left of the consistency graph before the motion is estimated.
enum class Pruning {
  kNone,
  kMaximumCore,  ///< KISS-Matcher, Lim et al. 2024
  kClique,       ///< TEASER++, Yang et al. 2021 (a large clique instead of the proven maximum)
};

/// Truncated least squares with graduated non-convexity after pruning: the TEASER++ / KISS-Matcher family.
struct GncOptions {
  Pruning pruning = Pruning::kClique;
  double noise_bound_m = 0.3;
  std::size_t clique_seeds = 100;
  std::size_t max_matches = 3000;
  double threshold_m = 0.6;
};

template <class Visitor>
void describe(Visitor& v, GncOptions& o) {
  v.choice("pruning", o.pruning,
           {{"none", Pruning::kNone}, {"maximum_core", Pruning::kMaximumCore}, {"clique", Pruning::kClique}},
           "what is left of the matches before the motion is estimated");
  v.field("noise_bound_m", o.noise_bound_m,
          "matches further off are outliers, metres; distances may differ by twice this");
  v.field("clique_seeds", o.clique_seeds, "matches from which a clique is grown");
  v.field("max_matches", o.max_matches, "only the best matches are used: the graph grows with their square");
  v.field("threshold_m", o.threshold_m, "inliers of the result are closer than this, metres");
}

void check(const GncOptions& options);

/// Finds the motion of the largest consistent set of matches. Deterministic.
Estimate gnc_clique(const PointPairs& pairs, const GncOptions& options = {});

/// Graduated non-convexity for truncated least squares (Yang et al. 2020) over the pairs at `indices`: the motion, and
/// in `weights` how far each pair was believed.
Pose gnc_tls(const PointPairs& pairs, const std::vector<std::size_t>& indices, double noise_bound_m,
             std::vector<double>* weights = nullptr);

}  // namespace loopmark::estimation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "loopmark/core/options.hpp"
#include "loopmark/estimation/estimate.hpp"
#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::estimation {

/// How minimal sets are drawn.
enum class Sampler {
  kUniform,
  kProsac,  ///< Chum and Matas 2005: the best matches first
};

/// How bad minimal sets are thrown away before they cost a full scoring.
enum class Rejection {
  kNone,
  kEdgeLength,  ///< edge-length consistency, checked before the motion is solved for
  kSprt,        ///< sequential probability ratio test, Matas and Chum 2005
};

/// What is done with a new best motion.
enum class LocalOptimization {
  kNone,
  kInner,     ///< LO-RANSAC, Chum et al. 2003: least squares on samples of the inliers
  kGraphCut,  ///< GC-RANSAC, Barath and Matas 2018: inliers labelled with spatial coherence first
};

/// RANSAC with the roles of the paper (Sec. 2 and appendix "Ablation Studies"); the defaults are the paper's choice.
struct RansacOptions {
  Sampler sampler = Sampler::kProsac;
  Rejection rejection = Rejection::kEdgeLength;
  LocalOptimization local = LocalOptimization::kInner;
  double threshold_m = 0.6;
  double score_factor = 1.5;
  double edge_similarity = 0.9;
  double confidence = 0.999;
  std::size_t min_iterations = 20;
  std::size_t max_iterations = 1'000'000;
  double time_limit_s = 0.0;
  std::size_t prosac_growth = 100'000;
  std::size_t local_trials = 20;
  std::size_t local_sample = 21;
  std::size_t local_rounds = 50;
  double spatial_coherence = 0.975;
  double neighbourhood_m = 3.0;
  std::uint64_t seed = 0;
};

template <class Visitor>
void describe(Visitor& v, RansacOptions& o) {
  v.choice("sampler", o.sampler, {{"uniform", Sampler::kUniform}, {"prosac", Sampler::kProsac}},
           "how minimal sets are drawn");
  v.choice("rejection", o.rejection,
           {{"none", Rejection::kNone}, {"edge_length", Rejection::kEdgeLength}, {"sprt", Rejection::kSprt}},
           "how bad minimal sets are thrown away early");
  v.choice("local", o.local,
           {{"none", LocalOptimization::kNone},
            {"inner", LocalOptimization::kInner},
            {"graph_cut", LocalOptimization::kGraphCut}},
           "local optimisation of a new best motion");
  v.field("threshold_m", o.threshold_m, "inliers are closer than this, metres");
  v.field("score_factor", o.score_factor, "the score (MSAC) is truncated at this many thresholds");
  v.field("edge_similarity", o.edge_similarity, "edges of a minimal set must agree to this ratio");
  v.field("confidence", o.confidence, "stop when a better motion was missed with no more than 1 - confidence");
  v.field("min_iterations", o.min_iterations, "minimal sets drawn at least");
  v.field("max_iterations", o.max_iterations, "minimal sets drawn at most");
  v.field("time_limit_s", o.time_limit_s,
          "give back the best so far after this time, seconds; 0: no limit (a limit "
          "makes results depend on the machine)");
  v.field("prosac_growth", o.prosac_growth, "samples after which PROSAC draws from all matches");
  v.field("local_trials", o.local_trials, "least-squares fits in one round of local optimisation");
  v.field("local_sample", o.local_sample, "inliers in each of them");
  v.field("local_rounds", o.local_rounds, "rounds of local optimisation in one run at most");
  v.field("spatial_coherence", o.spatial_coherence, "weight of the neighbours in the graph cut, 0 to 1");
  v.field("neighbourhood_m", o.neighbourhood_m, "matches closer than this in the source are neighbours, metres");
  v.field("seed", o.seed, "seed of the draws");
}

void check(const RansacOptions& options);

/// Finds the motion that most matches agree with; the pairs must be in the order of quality for PROSAC.
/// The same bytes for the same input, options and seed, unless a time limit is set.
Estimate ransac(const PointPairs& pairs, const RansacOptions& options = {});

/// Edge-length consistency of three pairs (paper, Sec. 2, ELC): every edge of one triangle is at least `similarity`
/// times as long as its image in the other.
bool edges_agree(const PointPairs& pairs, const std::size_t (&triple)[3], double similarity);

/// Decision threshold A of the sequential probability ratio test for inlier shares epsilon (right model) and delta
/// (wrong model), when solving for a model costs as much as `model_cost` residuals (Matas and Chum 2005, eq. 4-7).
double sprt_threshold(double epsilon, double delta, double model_cost);

/// Iterations after which an all-inlier sample of three was drawn with the confidence, for an inlier share w.
double iterations_needed(double w, double confidence);

}  // namespace loopmark::estimation

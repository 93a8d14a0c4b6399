// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/gnc.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "loopmark/estimation/consistency_graph.hpp"

namespace loopmark::estimation {

void check(const GncOptions& o) {
  require_option(o.noise_bound_m > 0, "noise_bound_m", "must be larger than 0");
  require_option(o.threshold_m > 0, "threshold_m", "must be larger than 0");
  require_option(o.clique_seeds > 0, "clique_seeds", "must be 1 or more");
}

namespace {

/// Weight of the truncated-least-squares surrogate at control parameter mu (Yang et al. 2020, eq. 14).
double surrogate_weight(double r2, double c2, double mu) {
  if (r2 >= (mu + 1.0) / mu * c2) {
    return 0.0;
  }
  if (r2 <= mu / (mu + 1.0) * c2) {
    return 1.0;
  }
  return std::sqrt(c2 * mu * (mu + 1.0) / r2) - mu;
}

std::vector<std::size_t> prune(const PointPairs& pairs, const GncOptions& options) {
  std::vector<std::size_t> all(pairs.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (options.pruning == Pruning::kNone) {
    return all;
  }
  const ConsistencyGraph graph(pairs, 2.0 * options.noise_bound_m);
  return options.pruning == Pruning::kMaximumCore ? maximum_core(graph) : large_clique(graph, options.clique_seeds);
}

PointPairs best_of(const PointPairs& pairs, std::size_t count) {
  const auto n = static_cast<std::ptrdiff_t>(std::min(count, pairs.size()));
  return {{pairs.source.begin(), pairs.source.begin() + n}, {pairs.target.begin(), pairs.target.begin() + n}};
}

}  // namespace

Pose gnc_tls(const PointPairs& pairs, const std::vector<std::size_t>& indices, double noise_bound_m,
             std::vector<double>* weights) {
  constexpr double kGrowth = 1.4;
  constexpr int kMaxIterations = 100;
  const double c2 = noise_bound_m * noise_bound_m;
  std::vector<double> w(indices.size(), 1.0);
  Pose T = fit_rigid(pairs, indices, w);
  double largest = 0.0;
  for (const std::size_t i : indices) {
    largest = std::max(largest, squared_residual(pairs, i, T));
  }
  double mu = 2.0 * largest > c2 ? c2 / (2.0 * largest - c2) : 0.0;
  for (int k = 0; k < kMaxIterations && mu > 0.0 && mu < 1e6; ++k) {
    bool undecided = false;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      w[i] = surrogate_weight(squared_residual(pairs, indices[i], T), c2, mu);
      undecided = undecided || (w[i] > 1e-6 && w[i] < 1.0 - 1e-6);
    }
    if (std::count_if(w.begin(), w.end(), [](double x) { return x > 0.0; }) < 3) {
      break;
    }
    T = fit_rigid(pairs, indices, w);
    if (!undecided && mu > 1.0) {
      break;
    }
    mu *= kGrowth;
  }
  if (weights != nullptr) {
    *weights = w;
  }
  return T;
}

Estimate gnc_clique(const PointPairs& pairs, const GncOptions& options) {
  check(options);
  const auto start = std::chrono::steady_clock::now();
  Estimate result;
  result.stop = EstimateStop::kTooFewMatches;
  if (pairs.size() < 3) {
    return result;
  }
  const PointPairs used = best_of(pairs, options.max_matches);
  const std::vector<std::size_t> consistent = prune(used, options);
  if (consistent.size() >= 3) {
    result.stop = EstimateStop::kDone;
    result.models = 1;
    result.T_target_source =
        reweighted_fit(pairs, gnc_tls(used, consistent, options.noise_bound_m), options.threshold_m);
    result.inliers = inliers_of(pairs, result.T_target_source, options.threshold_m);
    result.score = static_cast<double>(consistent.size());
    result.found = result.inliers.size() >= 3;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace loopmark::estimation

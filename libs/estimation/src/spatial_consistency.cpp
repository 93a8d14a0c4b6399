// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/spatial_consistency.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "loopmark/core/parallel.hpp"
#include "loopmark/estimation/consistency_graph.hpp"
#include "scorer.hpp"

namespace loopmark::estimation {

void check(const SpatialConsistencyOptions& o) {
  require_option(o.tolerance_m > 0, "tolerance_m", "must be larger than 0");
  require_option(o.threshold_m > 0, "threshold_m", "must be larger than 0");
  require_option(o.neighbours >= 3, "neighbours", "must be 3 or more");
  require_option(o.seeds > 0, "seeds", "must be 1 or more");
}

namespace {

constexpr int kPowerIterations = 10;

/// Leading eigenvector of the consistency graph by power iteration: how reliable each match is (PointDSC, Sec. 3.2).
std::vector<double> reliability(const ConsistencyGraph& graph) {
  std::vector<double> v(graph.size(), 1.0);
  std::vector<double> next(graph.size());
  for (int k = 0; k < kPowerIterations; ++k) {
    parallel_for(
        graph.size(),
        [&](std::size_t i) {
          double sum = 0.0;
          graph.for_each_neighbour(i, [&](std::size_t j) { sum += v[j]; });
          next[i] = sum;
        },
        64);
    const double largest = *std::max_element(next.begin(), next.end());
    if (!(largest > 0.0)) {
      break;
    }
    std::transform(next.begin(), next.end(), v.begin(), [largest](double x) { return x / largest; });
  }
  return v;
}

/// The most reliable matches, no two close to each other in the source.
std::vector<std::size_t> pick_seeds(const PointPairs& pairs, const std::vector<double>& reliable,
                                    const SpatialConsistencyOptions& options) {
  std::vector<std::size_t> order(reliable.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return reliable[a] > reliable[b]; });
  const double squared = options.seed_distance_m * options.seed_distance_m;
  std::vector<std::size_t> seeds;
  for (const std::size_t i : order) {
    const bool apart = std::all_of(seeds.begin(), seeds.end(), [&](std::size_t s) {
      return static_cast<double>((pairs.source[s] - pairs.source[i]).squaredNorm()) >= squared;
    });
    if (apart) {
      seeds.push_back(i);
    }
    if (seeds.size() == options.seeds) {
      break;
    }
  }
  return seeds;
}

/// The seed and the matches that share most consistent matches with it.
std::vector<std::size_t> group_of(const ConsistencyGraph& graph, std::size_t seed, std::size_t neighbours) {
  std::vector<std::pair<std::size_t, std::size_t>> order;  // (size - shared, match)
  graph.for_each_neighbour(seed, [&](std::size_t j) { order.emplace_back(graph.size() - graph.common(seed, j), j); });
  const std::size_t count = std::min(neighbours, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  std::vector<std::size_t> group{seed};
  for (std::size_t k = 0; k < count; ++k) {
    group.push_back(order[k].second);
  }
  return group;
}

/// Weights of a group: leading eigenvector of its second-order matrix, SC2(a, b) = [a, b joined] * shared(a, b).
std::vector<double> group_weights(const ConsistencyGraph& graph, const std::vector<std::size_t>& group) {
  const auto n = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      const std::size_t i = group[static_cast<std::size_t>(a)];
      const std::size_t j = group[static_cast<std::size_t>(b)];
      second(a, b) = second(b, a) = graph.joined(i, j) ? static_cast<double>(graph.common(i, j)) : 0.0;
    }
  }
  Eigen::VectorXd v = Eigen::VectorXd::Ones(n);
  for (int k = 0; k < kPowerIterations; ++k) {
    const Eigen::VectorXd next = second * v;
    if (!(next.norm() > 0.0)) {
      break;
    }
    v = next.normalized();
  }
  return {v.data(), v.data() + n};
}

}  // namespace

Estimate spatial_consistency(const PointPairs& pairs, const SpatialConsistencyOptions& options) {
  check(options);
  const auto start = std::chrono::steady_clock::now();
  Estimate result;
  result.stop = EstimateStop::kTooFewMatches;
  if (pairs.size() < 3) {
    return result;
  }
  const auto n = static_cast<std::ptrdiff_t>(std::min(options.max_matches, pairs.size()));
  const PointPairs used{{pairs.source.begin(), pairs.source.begin() + n},
                        {pairs.target.begin(), pairs.target.begin() + n}};
  const ConsistencyGraph graph(used, options.tolerance_m);
  const std::vector<std::size_t> seeds = pick_seeds(used, reliability(graph), options);
  const internal::Scorer scorer(used, options.threshold_m * options.score_factor);
  std::vector<std::pair<double, Pose>> answers(seeds.size(), {0.0, Pose::Identity()});
  parallel_for(seeds.size(), [&](std::size_t s) {
    const std::vector<std::size_t> group = group_of(graph, seeds[s], options.neighbours);
    if (group.size() >= 3) {
      const Pose T = fit_rigid(used, group, group_weights(graph, group));
      answers[s] = {scorer.score(T, 0.0), T};
    }
  });
  for (const auto& [score, T] : answers) {
    ++result.models;
    if (score > result.score) {
      result.score = score;
      result.T_target_source = T;
    }
  }
  result.stop = EstimateStop::kDone;
  result.T_target_source = reweighted_fit(pairs, result.T_target_source, options.threshold_m * options.score_factor);
  result.inliers = inliers_of(pairs, result.T_target_source, options.threshold_m);
  result.found = result.inliers.size() >= 3;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace loopmark::estimation

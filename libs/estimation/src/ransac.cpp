// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/ransac.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "local_optimizer.hpp"
#include "samplers.hpp"
#include "scorer.hpp"
#include "sprt.hpp"

namespace loopmark::estimation {

void check(const RansacOptions& o) {
  require_option(o.threshold_m > 0, "threshold_m", "must be larger than 0");
  require_option(o.score_factor > 0, "score_factor", "must be larger than 0");
  require_option(o.edge_similarity >= 0 && o.edge_similarity <= 1, "edge_similarity", "must be from 0 to 1");
  require_option(o.confidence > 0 && o.confidence < 1, "confidence", "must lie between 0 and 1");
  require_option(o.spatial_coherence >= 0 && o.spatial_coherence <= 1, "spatial_coherence", "must be from 0 to 1");
  require_option(o.neighbourhood_m > 0, "neighbourhood_m", "must be larger than 0");
  require_option(o.local_sample >= 3, "local_sample", "must be 3 or more");
  require_option(o.max_iterations > 0, "max_iterations", "must be 1 or more");
}

bool edges_agree(const PointPairs& pairs, const std::size_t (&triple)[3], double similarity) {
  const auto squared = static_cast<float>(similarity * similarity);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = triple[k];
    const std::size_t b = triple[(k + 1) % 3];
    const float s = (pairs.source[a] - pairs.source[b]).squaredNorm();
    const float t = (pairs.target[a] - pairs.target[b]).squaredNorm();
    if (s < squared * t || t < squared * s) {
      return false;
    }
  }
  return true;
}

double iterations_needed(double w, double confidence) {
  const double all = w * w * w;
  if (all >= 1.0) {
    return 0.0;
  }
  return all < 1e-15 ? std::numeric_limits<double>::infinity() : std::log(1.0 - confidence) / std::log1p(-all);
}

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// One run of RANSAC over its roles.
class Run {
 public:
  Run(const PointPairs& pairs, const RansacOptions& options)
      : pairs_(pairs),
        options_(options),
        rng_(options.seed),
        sampler_(options.sampler, pairs.size(), options.prosac_growth),
        scorer_(pairs, options.threshold_m * options.score_factor),
        local_(pairs, scorer_, options) {
    if (options.rejection == Rejection::kSprt) {
      test_.emplace(pairs, options.threshold_m, rng_);
    }
  }

  Estimate find() {
    search();
    polish();
    result_.inliers = inliers_of(pairs_, result_.T_target_source, options_.threshold_m);
    result_.found = result_.inliers.size() >= 3;
    result_.seconds = seconds_since(start_);
    return result_;
  }

 private:
  void search() {
    std::size_t triple[3];
    result_.stop = EstimateStop::kIterationLimit;
    while (result_.iterations < options_.max_iterations) {
      if (is_confident()) {
        result_.stop = EstimateStop::kConfident;
        return;
      }
      if (out_of_time()) {
        result_.stop = EstimateStop::kTimeLimit;
        return;
      }
      ++result_.iterations;
      sampler_.draw(rng_, triple);
      if (options_.rejection == Rejection::kEdgeLength && !edges_agree(pairs_, triple, options_.edge_similarity)) {
        continue;
      }
      consider(fit_rigid(pairs_, {triple[0], triple[1], triple[2]}));
    }
  }

  void consider(const Pose& T) {
    ++result_.models;
    if (test_ && !test_->passes(T)) {
      return;
    }
    double score = scorer_.score(T, result_.score);
    if (!(score > result_.score)) {
      return;
    }
    ++result_.scored;
    Pose best = T;
    optimized_ = options_.local != LocalOptimization::kNone && result_.iterations >= options_.min_iterations;
    if (optimized_) {
      local_.improve(best, score, rng_);
    }
    accept(best, score);
  }

  void accept(const Pose& T, double score) {
    result_.T_target_source = T;
    result_.score = score;
    const double share =
        static_cast<double>(inliers_of(pairs_, T, options_.threshold_m).size()) / static_cast<double>(pairs_.size());
    needed_ = iterations_needed(share, options_.confidence);
    if (test_) {
      test_->learn_good(share);
    }
  }

  /// A best found before local optimisation was allowed is optimised now; then the final reweighted least squares, kept
  /// only when the score improves.
  void polish() {
    if (options_.local == LocalOptimization::kNone || result_.score <= 0.0) {
      return;
    }
    if (!optimized_) {
      local_.improve(result_.T_target_source, result_.score, rng_);
    }
    const double threshold = options_.threshold_m * options_.score_factor;
    const Pose T = reweighted_fit(pairs_, result_.T_target_source, threshold);
    const double score = scorer_.score(T, result_.score);
    if (score > result_.score) {
      result_.T_target_source = T;
      result_.score = score;
    }
  }

  bool is_confident() const {
    return result_.iterations >= options_.min_iterations && static_cast<double>(result_.iterations) >= needed_;
  }

  bool out_of_time() const {
    constexpr std::size_t kLookEvery = 256;
    return options_.time_limit_s > 0.0 && result_.iterations % kLookEvery == 0 &&
           seconds_since(start_) > options_.time_limit_s;
  }

  Clock::time_point start_ = Clock::now();
  const PointPairs& pairs_;
  const RansacOptions& options_;
  Rng rng_;
  internal::TripleSampler sampler_;
  internal::Scorer scorer_;
  internal::LocalOptimizer local_;
  std::optional<internal::SequentialTest> test_;
  Estimate result_;
  double needed_ = std::numeric_limits<double>::infinity();
  bool optimized_ = false;
};

}  // namespace

Estimate ransac(const PointPairs& pairs, const RansacOptions& options) {
  check(options);
  if (pairs.size() < 3) {
    Estimate none;
    none.stop = EstimateStop::kTooFewMatches;
    return none;
  }
  return Run(pairs, options).find();
}

double sprt_threshold(double epsilon, double delta, double model_cost) {
  const double c = (1.0 - delta) * std::log((1.0 - delta) / (1.0 - epsilon)) + delta * std::log(delta / epsilon);
  const double start = model_cost * c + 1.0;
  double a = start;
  for (int k = 0; k < 20; ++k) {
    a = start + std::log(a);
  }
  return a;
}

}  // namespace loopmark::estimation

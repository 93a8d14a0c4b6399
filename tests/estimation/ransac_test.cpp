// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/ransac.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "synthetic_matches.hpp"

namespace loopmark::estimation {
namespace {

using testing_support::synthetic_matches;
using testing_support::SyntheticMatches;

void expect_found(const SyntheticMatches& world, const Estimate& estimate, double metres = 0.3) {
  const PoseError error = pose_error(estimate.T_target_source, world.T_target_source);
  EXPECT_TRUE(estimate.found);
  EXPECT_LT(error.translation_m, metres) << estimate.summary();
  EXPECT_LT(error.rotation_deg, 1.5) << estimate.summary();
}

struct Roles {
  Sampler sampler;
  Rejection rejection;
  LocalOptimization local;
  double least_share;
};

class RansacRoles : public testing::TestWithParam<Roles> {};

TEST_P(RansacRoles, FindTheTruthFromFewToManyInliers) {
  for (const double share : {0.01, 0.03, 0.1, 0.3, 0.6, 0.9}) {
    if (share < GetParam().least_share) {
      continue;
    }
    RansacOptions options;
    options.sampler = GetParam().sampler;
    options.rejection = GetParam().rejection;
    options.local = GetParam().local;
    options.max_iterations = 4'000'000;
    const SyntheticMatches world = synthetic_matches(share < 0.05 ? 2000 : 600, share, 0.1, 7);
    const bool rough = GetParam().local == LocalOptimization::kNone;
    expect_found(world, ransac(world.pairs, options), rough ? 1.0 : 0.3);
  }
}

// Without edge-length check every triple is solved for: shares below 10 % take too long for a unit test.
INSTANTIATE_TEST_SUITE_P(
    All, RansacRoles,
    testing::Values(Roles{Sampler::kProsac, Rejection::kEdgeLength, LocalOptimization::kInner, 0.01},
                    Roles{Sampler::kUniform, Rejection::kEdgeLength, LocalOptimization::kInner, 0.01},
                    Roles{Sampler::kProsac, Rejection::kEdgeLength, LocalOptimization::kGraphCut, 0.03},
                    Roles{Sampler::kProsac, Rejection::kEdgeLength, LocalOptimization::kNone, 0.03},
                    Roles{Sampler::kProsac, Rejection::kSprt, LocalOptimization::kInner, 0.1},
                    Roles{Sampler::kUniform, Rejection::kSprt, LocalOptimization::kInner, 0.1},
                    Roles{Sampler::kProsac, Rejection::kNone, LocalOptimization::kInner, 0.1},
                    Roles{Sampler::kUniform, Rejection::kNone, LocalOptimization::kNone, 0.1}));

TEST(Ransac, InverseAndMovedProblemsHaveTheMovedAnswer) {
  const SyntheticMatches world = synthetic_matches(500, 0.3, 0.05, 1);
  PointPairs swapped{world.pairs.target, world.pairs.source};
  const PoseError inverse = pose_error(ransac(swapped).T_target_source, world.T_target_source.inverse());
  EXPECT_LT(inverse.translation_m, 0.2);
  const Pose A = pose_from_yaw(1.0, {5, -8, 2});
  PointPairs moved = world.pairs;
  for (Eigen::Vector3f& q : moved.target) {
    q = (A * q.cast<double>()).cast<float>();
  }
  const PoseError shifted = pose_error(ransac(moved).T_target_source, A * ransac(world.pairs).T_target_source);
  EXPECT_LT(shifted.translation_m, 0.1);
  EXPECT_LT(shifted.rotation_deg, 0.2);
}

TEST(Ransac, SameSeedSameBytes) {
  const SyntheticMatches world = synthetic_matches(800, 0.05, 0.1, 2);
  const Estimate a = ransac(world.pairs);
  const Estimate b = ransac(world.pairs);
  EXPECT_EQ(std::memcmp(a.T_target_source.data(), b.T_target_source.data(), 16 * sizeof(double)), 0);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST(Ransac, StopsForTheReasonItSays) {
  const SyntheticMatches easy = synthetic_matches(300, 0.8, 0.05, 3);
  EXPECT_EQ(ransac(easy.pairs).stop, EstimateStop::kConfident);
  const SyntheticMatches hopeless = synthetic_matches(1000, 0.0, 0.05, 4);
  RansacOptions options;
  options.max_iterations = 500;
  const Estimate limited = ransac(hopeless.pairs, options);
  EXPECT_EQ(limited.stop, EstimateStop::kIterationLimit);
  EXPECT_EQ(limited.iterations, 500U);
  options.max_iterations = 1'000'000'000;
  options.time_limit_s = 0.05;
  const Estimate timed = ransac(hopeless.pairs, options);
  EXPECT_EQ(timed.stop, EstimateStop::kTimeLimit);
  EXPECT_LT(timed.seconds, 1.0);
  EXPECT_EQ(ransac({{{1, 2, 3}}, {{1, 2, 3}}}).stop, EstimateStop::kTooFewMatches);
  options.confidence = 1.0;
  EXPECT_THROW(ransac(easy.pairs, options), InputError);
}

TEST(Ransac, EdgeLengthCheckIsItsDefinition) {
  Rng rng(5);
  const SyntheticMatches world = synthetic_matches(300, 0.4, 1.0, 6);
  int agreeing = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const std::size_t triple[3] = {rng.below(100), 100 + rng.below(100), 200 + rng.below(100)};
    bool expected = true;
    for (int k = 0; k < 3; ++k) {
      const double s = (world.pairs.source[triple[k]] - world.pairs.source[triple[(k + 1) % 3]]).cast<double>().norm();
      const double t = (world.pairs.target[triple[k]] - world.pairs.target[triple[(k + 1) % 3]]).cast<double>().norm();
      expected = expected && s >= 0.9 * t && t >= 0.9 * s;
    }
    EXPECT_EQ(edges_agree(world.pairs, triple, 0.9), expected);
    agreeing += expected ? 1 : 0;
  }
  EXPECT_GT(agreeing, 20);
}

TEST(Ransac, SprtThresholdSolvesItsEquation) {
  for (const double epsilon : {0.05, 0.3, 0.8}) {
    const double delta = 0.01;
    const double c = (1 - delta) * std::log((1 - delta) / (1 - epsilon)) + delta * std::log(delta / epsilon);
    const double a = sprt_threshold(epsilon, delta, 100.0);
    EXPECT_NEAR(a, 100.0 * c + 1.0 + std::log(a), 1e-9);
  }
}

TEST(Ransac, ScoreIsTruncatedAtOneAndAHalfThresholds) {
  const SyntheticMatches world = synthetic_matches(400, 0.5, 0.2, 8);
  for (const double factor : {1.0, 1.5}) {
    RansacOptions options;
    options.score_factor = factor;
    const Estimate estimate = ransac(world.pairs, options);
    double expected = 0.0;
    const double t = options.threshold_m * factor;
    for (std::size_t i = 0; i < world.pairs.size(); ++i) {
      expected += std::max(0.0, 1.0 - squared_residual(world.pairs, i, estimate.T_target_source) / (t * t));
    }
    EXPECT_NEAR(estimate.score, expected, 0.05);
    EXPECT_EQ(estimate.inliers, inliers_of(world.pairs, estimate.T_target_source, options.threshold_m));
  }
}

TEST(Ransac, IterationsNeededIsTheRuleOfThePaper) {
  EXPECT_NEAR(iterations_needed(0.5, 0.99), std::log(0.01) / std::log(1 - 0.125), 1e-9);
  EXPECT_EQ(iterations_needed(1.0, 0.999), 0.0);
  EXPECT_TRUE(std::isinf(iterations_needed(0.0, 0.999)));
}

}  // namespace
}  // namespace loopmark::estimation

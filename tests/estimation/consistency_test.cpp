// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "loopmark/core/parallel.hpp"
#include "loopmark/estimation/consistency_graph.hpp"
#include "loopmark/estimation/gnc.hpp"
#include "loopmark/estimation/spatial_consistency.hpp"
#include "synthetic_matches.hpp"

namespace loopmark::estimation {
namespace {

using testing_support::synthetic_matches;
using testing_support::SyntheticMatches;

class GraphSize : public testing::TestWithParam<std::size_t> {};

TEST_P(GraphSize, JoinsPairsOfEqualDistance) {
  const std::size_t n = GetParam();
  const SyntheticMatches world = synthetic_matches(n, 0.4, 0.2, 1);
  const ConsistencyGraph graph(world.pairs, 0.6);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t degree = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double s = (world.pairs.source[i] - world.pairs.source[j]).cast<double>().norm();
      const double t = (world.pairs.target[i] - world.pairs.target[j]).cast<double>().norm();
      if (std::abs(std::abs(s - t) - 0.6) > 1e-4) {
        EXPECT_EQ(graph.joined(i, j), i != j && std::abs(s - t) < 0.6);
      }
      EXPECT_EQ(graph.joined(i, j), graph.joined(j, i));
      degree += graph.joined(i, j) ? 1U : 0U;
    }
    EXPECT_EQ(graph.degree(i), degree);
  }
}

INSTANTIATE_TEST_SUITE_P(WholeAndBrokenBlocks, GraphSize, testing::Values(3, 64, 65, 150, 192));

/// Core numbers by their definition: peel everything below k until nothing changes.
std::vector<std::size_t> brute_force_cores(const ConsistencyGraph& graph) {
  std::vector<std::size_t> cores(graph.size(), 0);
  for (std::size_t k = 1; k < graph.size(); ++k) {
    std::vector<bool> in(graph.size(), true);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < graph.size(); ++i) {
        std::size_t degree = 0;
        graph.for_each_neighbour(i, [&](std::size_t j) { degree += in[j] ? 1U : 0U; });
        if (in[i] && degree < k) {
          in[i] = false;
          changed = true;
        }
      }
    }
    for (std::size_t i = 0; i < graph.size(); ++i) {
      cores[i] = in[i] ? k : cores[i];
    }
  }
  return cores;
}

TEST(ConsistencyGraph, CoreNumbersAreThoseOfPeeling) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const SyntheticMatches world = synthetic_matches(90, 0.3, 0.2, seed);
    const ConsistencyGraph graph(world.pairs, 2.0);
    EXPECT_EQ(core_numbers(graph), brute_force_cores(graph));
  }
}

TEST(ConsistencyGraph, CliqueIsAClique) {
  const SyntheticMatches world = synthetic_matches(400, 0.1, 0.05, 2);
  const ConsistencyGraph graph(world.pairs, 0.6);
  const std::vector<std::size_t> clique = large_clique(graph, 50);
  for (const std::size_t a : clique) {
    for (const std::size_t b : clique) {
      EXPECT_TRUE(a == b || graph.joined(a, b));
    }
  }
  EXPECT_GE(clique.size(), 39U);
}

class InlierShare : public testing::TestWithParam<double> {
 protected:
  static void expect_found(const SyntheticMatches& world, const Estimate& estimate) {
    const PoseError error = pose_error(estimate.T_target_source, world.T_target_source);
    EXPECT_TRUE(estimate.found);
    EXPECT_LT(error.translation_m, 0.3) << estimate.summary();
    EXPECT_LT(error.rotation_deg, 1.5) << estimate.summary();
  }
  static SyntheticMatches world(double sigma) {
    return synthetic_matches(GetParam() < 0.05 ? 2000 : 500, GetParam(), sigma, 3);
  }
};

TEST_P(InlierShare, GncAfterTheCliqueFindsTheTruth) { expect_found(world(0.08), gnc_clique(world(0.08).pairs)); }

TEST_P(InlierShare, GncAfterTheCoreFindsTheTruth) {
  GncOptions options;
  options.pruning = Pruning::kMaximumCore;
  if (GetParam() >= 0.1) {  // below, chance cores are as dense as the right one
    expect_found(world(0.08), gnc_clique(world(0.08).pairs, options));
  }
}

TEST_P(InlierShare, SpatialConsistencyFindsTheTruth) {
  expect_found(world(0.08), spatial_consistency(world(0.08).pairs));
}

INSTANTIATE_TEST_SUITE_P(Shares, InlierShare, testing::Values(0.01, 0.03, 0.1, 0.3, 0.6, 0.9));

TEST(Gnc, RejectsOutliersWithoutPruning) {
  const SyntheticMatches world = synthetic_matches(300, 0.6, 0.05, 4);
  std::vector<std::size_t> all(300);
  for (std::size_t i = 0; i < 300; ++i) {
    all[i] = i;
  }
  std::vector<double> weights;
  const Pose T = gnc_tls(world.pairs, all, 0.3, &weights);
  EXPECT_LT(pose_error(T, world.T_target_source).translation_m, 0.05);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(weights[i] > 0.5, squared_residual(world.pairs, i, T) < 0.09);
  }
}

TEST(Gnc, SameBytesAtAnyNumberOfThreads) {
  const SyntheticMatches world = synthetic_matches(900, 0.05, 0.1, 5);
  set_thread_count(1);
  const Estimate gnc = gnc_clique(world.pairs);
  const Estimate sc2 = spatial_consistency(world.pairs);
  set_thread_count(4);
  const Pose gnc_4 = gnc_clique(world.pairs).T_target_source;
  const Pose sc2_4 = spatial_consistency(world.pairs).T_target_source;
  set_thread_count(0);
  EXPECT_TRUE(gnc.T_target_source.matrix() == gnc_4.matrix());
  EXPECT_TRUE(sc2.T_target_source.matrix() == sc2_4.matrix());
}

TEST(Gnc, InverseProblemHasTheInverseAnswer) {
  const SyntheticMatches world = synthetic_matches(500, 0.2, 0.05, 6);
  const PointPairs swapped{world.pairs.target, world.pairs.source};
  const Pose gnc = gnc_clique(world.pairs).T_target_source * gnc_clique(swapped).T_target_source;
  EXPECT_LT(pose_error(gnc, Pose::Identity()).translation_m, 0.05);
  const Pose sc2 = spatial_consistency(world.pairs).T_target_source * spatial_consistency(swapped).T_target_source;
  EXPECT_LT(pose_error(sc2, Pose::Identity()).translation_m, 0.05);
}

TEST(Gnc, TooFewMatchesAreNoAnswer) {
  EXPECT_FALSE(gnc_clique({}).found);
  EXPECT_FALSE(spatial_consistency({}).found);
  EXPECT_EQ(gnc_clique({}).stop, EstimateStop::kTooFewMatches);
}

}  // namespace
}  // namespace loopmark::estimation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/pose_graph/src/consistency.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "../../libs/pose_graph/src/max_clique.hpp"
#include "drives.hpp"

namespace loopmark::pose_graph {
namespace {

using namespace loopmark::testing;

TEST(CycleChi2, OfTrueLoopsFollowsItsDistribution) {
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Rng rng(seed);
    Drive drive = circuit(2, 200.0, rng);
    add_loop(drive, 10, 112, rng);
    add_loop(drive, 140, 38, rng);  // turned round: must not matter
    const internal::Segments segments = internal::find_segments(drive.graph);
    const std::size_t first = drive.graph.edges.size() - 2;
    sum += internal::cycle_chi2(drive.graph, segments, first, first + 1);
    ++count;
  }
  // Mean 6, standard deviation of the mean sqrt(12 / 200) = 0.25.
  EXPECT_NEAR(sum / count, 6.0, 1.0);
}

TEST(CycleChi2, OfAWrongLoopIsLarge) {
  Rng rng(1);
  Drive drive = circuit(2, 200.0, rng);
  add_loop(drive, 10, 112, rng);
  add_wrong_loop(drive, rng);
  const internal::Segments segments = internal::find_segments(drive.graph);
  const std::size_t first = drive.graph.edges.size() - 2;
  EXPECT_GT(internal::cycle_chi2(drive.graph, segments, first, first + 1), 100.0);
}

TEST(CycleChi2, WorksAcrossSegmentsInDifferentFrames) {
  Rng rng(2);
  Drive drive = circuit(2, 200.0, rng);
  drive.graph.edges.erase(drive.graph.edges.begin() + 99);
  const Pose step = pose_from_yaw(1.0, {100, 50, 3});
  for (std::size_t i = 100; i < 200; ++i) {
    drive.graph.T_map_node[i] = step * drive.graph.T_map_node[i];
  }
  add_loop(drive, 10, 112, rng);
  add_loop(drive, 160, 61, rng);
  const internal::Segments segments = internal::find_segments(drive.graph);
  ASSERT_EQ(segments.nodes.size(), 2U);
  const std::size_t first = drive.graph.edges.size() - 2;
  EXPECT_LT(internal::cycle_chi2(drive.graph, segments, first, first + 1), 30.0);
}

/// The size of the largest clique, by trying every subset.
std::size_t brute_force(const internal::BitMatrix& related) {
  std::size_t best = 0;
  for (std::uint32_t subset = 0; subset < (1U << related.size()); ++subset) {
    bool clique = true;
    for (std::size_t i = 0; clique && i < related.size(); ++i) {
      for (std::size_t j = i + 1; clique && j < related.size(); ++j) {
        clique = (subset >> i & 1U) == 0 || (subset >> j & 1U) == 0 || related.test(i, j);
      }
    }
    best = clique ? std::max<std::size_t>(best, static_cast<std::size_t>(std::popcount(subset))) : best;
  }
  return best;
}

TEST(LargeClique, IsACliqueAndNearlyAlwaysTheLargest) {
  int largest = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Rng rng(seed);
    internal::BitMatrix related(14);
    for (std::size_t i = 0; i < 14; ++i) {
      for (std::size_t j = i + 1; j < 14; ++j) {
        if (rng.uniform() < 0.6) {
          related.set(i, j);
          related.set(j, i);
        }
      }
    }
    const std::vector<std::size_t> clique = internal::large_clique(related);
    for (const std::size_t a : clique) {
      for (const std::size_t b : clique) {
        EXPECT_TRUE(a == b || related.test(a, b));
      }
    }
    const std::size_t best = brute_force(related);
    EXPECT_GE(clique.size() + 1, best);
    largest += clique.size() == best ? 1 : 0;
  }
  EXPECT_GE(largest, 36);
}

}  // namespace
}  // namespace loopmark::pose_graph

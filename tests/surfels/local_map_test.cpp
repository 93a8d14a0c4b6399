// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/surfels/local_map.hpp"

#include <gtest/gtest.h>

#include "loopmark/core/random.hpp"

namespace loopmark::surfels {
namespace {

std::vector<Eigen::Vector3d> random_points(std::size_t count, double span, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(rng.uniform(-span, span), rng.uniform(-span, span), rng.uniform(-span, span));
  }
  return points;
}

TEST(LocalMap, NearestAgreesWithBruteForce) {
  LocalMap map(1.0, LocalMap::kMaxPoints);
  // Sparse enough that every point is kept.
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& p : random_points(4000, 8.0, 1)) {
    const bool close = std::any_of(kept.begin(), kept.end(), [&](const auto& k) { return (k - p).norm() < 0.25; });
    if (!close) {
      kept.push_back(p);
    }
  }
  map.insert(kept);
  int found = 0;
  for (const Eigen::Vector3d& query : random_points(500, 8.0, 2)) {
    double best = 1e9;
    for (const Eigen::Vector3d& p : kept) {
      best = std::min(best, (p - query).norm());
    }
    MapMatch match;
    const bool hit = map.nearest(query, 0.9, match);
    EXPECT_EQ(hit, best < 0.9);
    if (hit) {
      ++found;
      EXPECT_NEAR(match.distance_m, best, 1e-5);
      EXPECT_NEAR((match.point - query).norm(), best, 1e-5);
    }
  }
  EXPECT_GT(found, 100);
}

TEST(LocalMap, NormalsOfAPlaneAndNoneOfALine) {
  LocalMap map(1.0, 16);
  Rng rng(3);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 3000; ++i) {
    points.emplace_back(rng.uniform(0, 5), rng.uniform(0, 5), 100.3);
  }
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(50.0 + 0.02 * i, 0.5, 0.5);
  }
  map.insert(points);
  MapMatch match;
  ASSERT_TRUE(map.nearest({2.5, 2.5, 100.4}, 0.5, match));
  EXPECT_NEAR(std::abs(match.normal.z()), 1.0, 1e-3);
  ASSERT_TRUE(map.nearest({52.0, 0.5, 0.5}, 0.5, match));
  EXPECT_TRUE(match.normal.isZero());
}

TEST(LocalMap, ForgetsWhatIsFarAndKeepsTheRest) {
  LocalMap map(1.0, 16);
  map.insert({{0.5, 0.5, 0.5}, {200.5, 0.5, 0.5}});
  map.forget_beyond({200.0, 0.0, 0.0}, 50.0);
  EXPECT_EQ(map.voxel_count(), 1U);
  MapMatch match;
  EXPECT_FALSE(map.nearest({0.5, 0.5, 0.5}, 0.5, match));
  EXPECT_TRUE(map.nearest({200.4, 0.5, 0.5}, 0.5, match));
}

TEST(LocalMap, FarFromTheOriginIsAsExactAsNear) {
  LocalMap map(1.0, 16);
  const Eigen::Vector3d far(123456.789, -98765.432, 10.0);
  map.insert({far});
  MapMatch match;
  ASSERT_TRUE(map.nearest(far + Eigen::Vector3d(0.1, 0, 0), 0.5, match));
  EXPECT_NEAR(match.distance_m, 0.1, 1e-6);
}

}  // namespace
}  // namespace loopmark::surfels

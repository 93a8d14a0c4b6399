// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/search/kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "loopmark/core/random.hpp"

namespace loopmark::search {
namespace {

std::vector<Eigen::Vector3f> random_points(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(rng.uniform(-10, 10), rng.uniform(-10, 10), rng.uniform(-2, 2));
  }
  return points;
}

TEST(KdTree, AgreesWithBruteForce) {
  const auto points = random_points(2000, 1);
  const KdTree tree(points);
  for (const Eigen::Vector3f& query : random_points(100, 2)) {
    std::vector<float> distances;
    for (const Eigen::Vector3f& point : points) {
      distances.push_back((point - query).squaredNorm());
    }
    std::sort(distances.begin(), distances.end());
    EXPECT_FLOAT_EQ(tree.nearest(query, 100.0F)->squared_distance, distances[0]);
    const auto five = tree.k_nearest(query, 5);
    ASSERT_EQ(five.size(), 5U);
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_FLOAT_EQ(five[k].squared_distance, distances[k]);
    }
    const auto near =
        static_cast<std::size_t>(std::count_if(distances.begin(), distances.end(), [](float d) { return d < 4.0F; }));
    EXPECT_EQ(tree.within(query, 2.0F).size(), near);
  }
}

TEST(KdTree, NothingNearGivesNothing) {
  const KdTree tree(random_points(10, 3));
  EXPECT_FALSE(tree.nearest({100, 100, 100}, 1.0F).has_value());
  EXPECT_FALSE(KdTree(std::vector<Eigen::Vector3f>{}).nearest({0, 0, 0}, 1.0F).has_value());
  EXPECT_TRUE(KdTree(std::vector<Eigen::Vector3f>{}).k_nearest({0, 0, 0}, 3).empty());
}

}  // namespace
}  // namespace loopmark::search

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/ground.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "loopmark/core/random.hpp"

namespace loopmark::features {
namespace {

TEST(Ground, TellsASlopeFromWhatStandsOnIt) {
  Rng rng(1);
  std::vector<Eigen::Vector3f> points;
  std::vector<bool> expected;
  for (int i = 0; i < 6000; ++i) {
    const double x = rng.uniform(-40, 40);
    const double y = rng.uniform(-40, 40);
    const bool ground = i % 3 != 0;
    const double height = ground ? 0.03 * rng.normal() : rng.uniform(1.2, 4.0);
    points.push_back(Eigen::Vector3d(x, y, -1.7 + 0.02 * x + height).cast<float>());
    expected.push_back(ground);
  }
  const std::vector<bool> found = ground_points(points, {});
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    wrong += found[i] != expected[i] ? 1U : 0U;
  }
  EXPECT_LT(wrong, points.size() / 50);
}

TEST(Ground, LevelSurfacesMayBeHigher) {
  const std::vector<Eigen::Vector3f> points{{0, 0, 0}, {1, 1, 0.7F}, {2, 1, 0.7F}};
  const std::vector<Eigen::Vector3f> normals{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}};
  const std::vector<bool> found = ground_points(points, normals);
  EXPECT_EQ(found, (std::vector<bool>{true, true, false}));
}

TEST(Ground, TakesEmptyAndBrokenInput) {
  EXPECT_TRUE(ground_points({}, {}).empty());
  EXPECT_FALSE(ground_points({{std::numeric_limits<float>::quiet_NaN(), 0, 0}}, {})[0]);
  GroundOptions options;
  options.cell_m = 0;
  EXPECT_THROW(ground_points({}, {}, options), InputError);
}

}  // namespace
}  // namespace loopmark::features

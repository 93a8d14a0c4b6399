// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/landmarks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "loopmark/core/random.hpp"

namespace loopmark::bev {
namespace {

/// Cells of a square of `width` metres.
void put(std::vector<StructureCell>& cells, float x, float y, float width, std::uint8_t bands) {
  const int n = std::max(1, static_cast<int>(width / kStructureCell));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      cells.push_back({x + kStructureCell * static_cast<float>(i), y + kStructureCell * static_cast<float>(j), bands});
    }
  }
}

Landmark moved(const Landmark& l, double yaw, double x, double y) {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {static_cast<float>(c * l.x - s * l.y + x), static_cast<float>(s * l.x + c * l.y + y), l.tall};
}

std::vector<Landmark> scattered(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < count; ++i) {
    landmarks.push_back(
        {static_cast<float>(rng.uniform(-60, 60)), static_cast<float>(rng.uniform(-60, 60)), i % 3 != 0});
  }
  return landmarks;
}

TEST(FindLandmarks, KeepsWhatStandsAloneAndIsNarrow) {
  std::vector<StructureCell> cells;
  put(cells, 10.25F, 4.25F, 0.5F, 0b111);    // a pole
  put(cells, -20.25F, 8.25F, 4.0F, 0b001);   // a car
  put(cells, 5.25F, -30.25F, 20.0F, 0b111);  // a building
  put(cells, 40.25F, 40.25F, 0.5F, 0b011);   // two posts a metre apart are one thing
  put(cells, 41.25F, 40.25F, 0.5F, 0b011);
  const auto landmarks = find_landmarks(cells);
  ASSERT_EQ(landmarks.size(), 3U);
  EXPECT_TRUE(landmarks[0].tall);  // the tall ones first, then by distance
  EXPECT_FLOAT_EQ(landmarks[0].x, 10.25F);
  EXPECT_FLOAT_EQ(landmarks[1].x, 40.75F);
  EXPECT_FALSE(landmarks[2].tall);
  EXPECT_FLOAT_EQ(landmarks[2].x, -20.25F + 1.75F);
}

TEST(FindLandmarks, AreNoMoreThanTheLimit) {
  std::vector<StructureCell> cells;
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      put(cells, 5.25F * static_cast<float>(column), 5.25F * static_cast<float>(row), 0.5F, 0b010);
    }
  }
  EXPECT_EQ(find_landmarks(cells).size(), kMostLandmarks);
}

TEST(MatchLandmarks, FindsTheMotionAmongStrangers) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(100 + seed);
    const double yaw = rng.uniform(-3.1, 3.1);
    const double x = rng.uniform(-50, 50);
    const double y = rng.uniform(-50, 50);
    std::vector<Landmark> source = scattered(18, seed);  // 8 in common, 10 that only one of the two sees
    std::vector<Landmark> target = scattered(10, 1000 + seed);
    for (std::size_t i = 0; i < 8; ++i) {
      Landmark l = moved(source[i], yaw, x, y);
      l.x += static_cast<float>(0.1 * rng.normal());
      l.y += static_cast<float>(0.1 * rng.normal());
      target.push_back(l);
    }
    const auto found = match_landmarks(source, target, 5);
    ASSERT_FALSE(found.empty());
    EXPECT_LT(std::hypot(found[0].x - x, found[0].y - y), 0.4) << seed;
    EXPECT_LT(std::abs(std::remainder(found[0].yaw - yaw, 2.0 * M_PI)), 0.02) << seed;
    EXPECT_NEAR(found[0].score, landmark_score(source, target, found[0].yaw, found[0].x, found[0].y), 1e-4);
    EXPECT_LE(found.size(), 5U);
  }
}

TEST(MatchLandmarks, TwoTellNothing) {
  const std::vector<Landmark> two = {{0, 0, true}, {20, 0, true}};
  EXPECT_TRUE(match_landmarks(two, two, 5).empty());
  EXPECT_TRUE(match_landmarks({}, two, 5).empty());
}

TEST(LandmarkScore, CountsWhatIsMetAndWhatShouldHaveBeen) {
  const std::vector<Landmark> source = {{0, 10, true}, {10, 0, true}, {0, 20, false}, {20, 20, true}, {70, 0, true}};
  const std::vector<Landmark> target = {{0.3F, 10, true}, {10, 0.5F, true}, {0, 20, false}};
  // Two tall ones and a low one are met; one is missing within 40 m, one is too far away to be missed.
  EXPECT_NEAR(landmark_score(source, target, 0.0, 0.0, 0.0), 2.0 + 0.5 - 0.25, 1e-6);
}

}  // namespace
}  // namespace loopmark::bev

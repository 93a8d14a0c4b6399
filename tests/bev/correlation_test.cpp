// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::bev {
namespace {

struct Planar {
  double yaw, x, y;
};

/// `count` cells anywhere within `reach` metres, seen as they are and from elsewhere.
std::pair<BirdseyeView, BirdseyeView> structure_pair(int count, double reach, const Planar& motion) {
  Rng rng(11);
  std::pair<BirdseyeView, BirdseyeView> views;
  for (int i = 0; i < count; ++i) {
    const double x = rng.uniform(-reach, reach);
    const double y = rng.uniform(-reach, reach);
    const auto bands = static_cast<std::uint8_t>(1U << rng.below(3));
    views.first.structure.push_back({static_cast<float>(x), static_cast<float>(y), bands});
    views.second.structure.push_back(
        {static_cast<float>(std::cos(motion.yaw) * x - std::sin(motion.yaw) * y + motion.x),
         static_cast<float>(std::sin(motion.yaw) * x + std::cos(motion.yaw) * y + motion.y), bands});
  }
  return views;
}

bool holds(const std::vector<PlanarHypothesis>& found, const Planar& motion, std::size_t among) {
  for (std::size_t i = 0; i < std::min(among, found.size()); ++i) {
    const double turn = std::abs(std::remainder(found[i].yaw - motion.yaw, 2.0 * std::numbers::pi));
    if (turn < 0.06 && std::hypot(found[i].x - motion.x, found[i].y - motion.y) < 1.2) {
      return true;
    }
  }
  return false;
}

TEST(Correlate, FindsAnyYawAndShift) {
  for (const Planar& motion : {Planar{0.0, 3.0, -4.0}, Planar{2.4, -25.0, 11.0}, Planar{-1.1, 40.0, 30.0}}) {
    const auto [source, target] = structure_pair(300, 35.0, motion);
    EXPECT_TRUE(holds(correlate(source, target, {}), motion, 1)) << motion.yaw;
  }
}

TEST(Correlate, ShiftsLongerThanHalfTheGridAreAmongTheUnfoldedPeaks) {
  const Planar motion{0.7, 95.0, -20.0};
  const auto [source, target] = structure_pair(200, 30.0, motion);
  EXPECT_TRUE(holds(correlate(source, target, {}), motion, 4));
  CorrelationOptions options;
  options.longest_shift_m = 70.0;
  EXPECT_FALSE(holds(correlate(source, target, options), motion, 400));
}

TEST(Correlate, ReliefOfTheGroundDecidesWhereTwoThingsStand) {
  const Planar motion{-0.6, 6.0, 9.0};
  auto [source, target] = structure_pair(2, 20.0, motion);
  Rng rng(5);
  for (int i = 0; i < 3000; ++i) {
    const double x = rng.uniform(-30, 30);
    const double y = rng.uniform(-30, 30);
    const auto relief = static_cast<float>(0.2 * std::sin(0.9 * x + 0.3) * std::cos(1.3 * y - 0.2 * x));
    source.relief.push_back({static_cast<float>(x), static_cast<float>(y), relief});
    target.relief.push_back({static_cast<float>(std::cos(motion.yaw) * x - std::sin(motion.yaw) * y + motion.x),
                             static_cast<float>(std::sin(motion.yaw) * x + std::cos(motion.yaw) * y + motion.y),
                             relief});
  }
  EXPECT_TRUE(holds(correlate(source, target, {}), motion, 1));
}

TEST(Correlate, SameHypothesesAtAnyNumberOfThreads) {
  const auto [source, target] = structure_pair(100, 30.0, {1.0, 5.0, 5.0});
  const auto all = correlate(source, target, {});
  set_thread_count(1);
  const auto one = correlate(source, target, {});
  set_thread_count(0);
  ASSERT_EQ(all.size(), one.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].score, one[i].score);
    EXPECT_EQ(all[i].x, one[i].x);
  }
}

TEST(Correlate, NothingStandsNothingIsFound) { EXPECT_TRUE(correlate({}, {}, {}).empty()); }

}  // namespace
}  // namespace loopmark::bev

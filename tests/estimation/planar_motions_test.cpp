// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/planar_motions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::estimation {
namespace {

Eigen::Vector3f anywhere(Rng& rng) {
  return {static_cast<float>(rng.uniform(-50.0, 50.0)), static_cast<float>(rng.uniform(-50.0, 50.0)),
          static_cast<float>(rng.uniform(-1.0, 1.0))};
}

/// Matches of which every `right_every`-th follows T, with noise, in an order that says nothing of who is right.
PointPairs matches(const Pose& T, std::size_t count, std::size_t right_every, std::uint64_t seed) {
  Rng rng(seed);
  PointPairs pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f s = anywhere(rng);
    const Eigen::Vector3f noise(static_cast<float>(0.1 * rng.normal()), static_cast<float>(0.1 * rng.normal()),
                                static_cast<float>(0.1 * rng.normal()));
    pairs.source.push_back(s);
    pairs.target.push_back(i % right_every == 0 ? Eigen::Vector3f((T * s.cast<double>()).cast<float>() + noise)
                                                : anywhere(rng));
  }
  return pairs;
}

void expect_motion(const PlanarMotion& found, const Pose& T) {
  const PoseError error = pose_error(pose_from_yaw(found.yaw, found.t), T);
  EXPECT_LT(error.translation_m, 0.15);
  EXPECT_LT(error.rotation_deg, 0.3);
}

TEST(PlanarMotions, FindTheMotionAmongManyWrongMatches) {
  for (const double yaw : {0.0, 1.0, 3.0, -2.5}) {
    const Pose T = pose_from_yaw(yaw, {12.0, -7.0, 0.4});
    const std::vector<PlanarMotion> found = find_planar_motions(matches(T, 300, 10, 1));
    ASSERT_FALSE(found.empty());
    expect_motion(found.front(), T);
    EXPECT_GE(found.front().inliers, 28U);
  }
}

TEST(PlanarMotions, ReturnBothWhereTwoMotionsHaveFollowers) {
  const Pose one = pose_from_yaw(0.2, {20.0, 0.0, 0.0});
  const Pose other = pose_from_yaw(0.2, {-15.0, 0.0, 0.0});
  PointPairs pairs = matches(one, 200, 5, 2);
  const PointPairs more = matches(other, 200, 6, 3);
  pairs.source.insert(pairs.source.end(), more.source.begin(), more.source.end());
  pairs.target.insert(pairs.target.end(), more.target.begin(), more.target.end());
  const std::vector<PlanarMotion> found = find_planar_motions(pairs);
  ASSERT_GE(found.size(), 2U);
  expect_motion(found[0], one);
  expect_motion(found[1], other);
  EXPECT_GT(found[0].score, found[1].score);
}

TEST(PlanarMotions, TheInverseIsFoundWhereTheScansChangePlaces) {
  const Pose T = pose_from_yaw(2.2, {30.0, 5.0, -0.3});
  PointPairs pairs = matches(T, 200, 4, 4);
  std::swap(pairs.source, pairs.target);
  const std::vector<PlanarMotion> found = find_planar_motions(pairs);
  ASSERT_FALSE(found.empty());
  expect_motion(found.front(), T.inverse());
}

TEST(PlanarMotions, AreTheSameAtAnyNumberOfThreads) {
  const PointPairs pairs = matches(pose_from_yaw(1.0, {5.0, 5.0, 0.0}), 400, 12, 5);
  set_thread_count(1);
  const std::vector<PlanarMotion> one = find_planar_motions(pairs);
  set_thread_count(3);
  const std::vector<PlanarMotion> three = find_planar_motions(pairs);
  set_thread_count(0);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].yaw, three[i].yaw);
    EXPECT_EQ(one[i].t, three[i].t);
    EXPECT_EQ(one[i].score, three[i].score);
  }
}

TEST(PlanarMotions, NeedTwoMatchesThatAreFarEnoughApart) {
  PointPairs pairs = matches(Pose::Identity(), 1, 1, 6);
  EXPECT_TRUE(find_planar_motions(pairs).empty());
  pairs.source.push_back(pairs.source.front() + Eigen::Vector3f(1.0F, 0.0F, 0.0F));
  pairs.target.push_back(pairs.target.front() + Eigen::Vector3f(1.0F, 0.0F, 0.0F));
  EXPECT_TRUE(find_planar_motions(pairs).empty());
  PlanarMotionOptions options;
  options.min_edge_m = 0.5;
  EXPECT_EQ(find_planar_motions(pairs, options).size(), 1U);
  options.threshold_m = 0.0;
  EXPECT_THROW(find_planar_motions(pairs, options), InputError);
}

}  // namespace
}  // namespace loopmark::estimation

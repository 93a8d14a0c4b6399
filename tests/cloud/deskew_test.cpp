// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/deskew.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "loopmark/core/random.hpp"

namespace loopmark::cloud {
namespace {

TEST(Deskew, TimeFollowsTheAzimuth) {
  SweepModel sweep;  // clockwise, seam behind, stamp in the middle: t = -azimuth / (2 pi) * period
  EXPECT_NEAR(time_from_azimuth({1, 0, 0}, sweep), 0.0F, 1e-6F);
  EXPECT_NEAR(time_from_azimuth({0, 1, 0}, sweep), -0.025F, 1e-6F);
  EXPECT_NEAR(time_from_azimuth({0, -1, 0}, sweep), 0.025F, 1e-6F);
  EXPECT_NEAR(time_from_azimuth({-1, 1e-4F, 0}, sweep), -0.05F, 1e-4F);
  sweep.clockwise = false;
  EXPECT_NEAR(time_from_azimuth({0, 1, 0}, sweep), 0.025F, 1e-6F);
  sweep.stamp_at = 0.0;
  sweep.seam_azimuth_rad = 0.0;
  EXPECT_NEAR(time_from_azimuth({0, 1, 0}, sweep), 0.025F, 1e-6F);
  EXPECT_NEAR(time_from_azimuth({0, -1, 0}, sweep), 0.075F, 1e-6F);
}

TEST(Deskew, UndoesAConstantMotion) {
  Rng rng(3);
  Vector6d velocity;
  velocity << 15.0, 0.5, -0.1, 0.02, -0.01, 0.6;
  std::vector<Eigen::Vector3f> still;
  std::vector<Eigen::Vector3f> seen;
  std::vector<float> times;
  for (int i = 0; i < 500; ++i) {
    still.emplace_back(rng.uniform(-40, 40), rng.uniform(-40, 40), rng.uniform(-2, 5));
    times.push_back(static_cast<float>(rng.uniform(-0.05, 0.05)));
    // At time t the sensor has moved by exp(velocity * t); it sees the point in its own frame of then.
    seen.push_back((exp_se3(times.back() * velocity).inverse() * still.back().cast<double>()).cast<float>());
  }
  const std::vector<Eigen::Vector3f> found = deskewed(seen, times, velocity);
  for (std::size_t i = 0; i < still.size(); ++i) {
    EXPECT_LT((found[i] - still[i]).norm(), 1e-3F);
  }
}

TEST(Deskew, LeavesAStandingSensorAlone) {
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {-4, 5, 6}};
  EXPECT_EQ(deskewed(points, {-0.05F, 0.05F}, Vector6d::Zero()), points);
  EXPECT_THROW(deskewed(points, {0.0F}, Vector6d::Ones()), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::cloud

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/trajectory_metrics.hpp"

#include <gtest/gtest.h>

namespace loopmark::mapping {
namespace {

std::vector<Pose> straight(std::size_t count, double step_m) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(pose_from_yaw(0.0, {step_m * static_cast<double>(i), std::sin(0.1 * static_cast<double>(i)), 0.0}));
  }
  return poses;
}

TEST(TrajectoryMetrics, ARigidMotionOfTheWholeIsNoError) {
  const std::vector<Pose> truth = straight(300, 1.0);
  std::vector<Pose> estimate;
  for (const Pose& pose : truth) {
    estimate.push_back(pose_from_yaw(1.0, {5, 6, 7}) * pose);
  }
  EXPECT_NEAR(absolute_error(estimate, truth).rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(kitti_error(estimate, truth).translation_percent, 0.0, 1e-9);
}

TEST(TrajectoryMetrics, AScaleErrorIsThatManyPercent) {
  std::vector<Pose> truth;
  std::vector<Pose> estimate;
  for (int i = 0; i < 1000; ++i) {
    truth.push_back(pose_from_yaw(0.0, {1.0 * i, 0, 0}));
    estimate.push_back(pose_from_yaw(0.0, {1.01 * i, 0, 0}));
  }
  const KittiError error = kitti_error(estimate, truth);
  // The segment ends at the first pose beyond its length: one metre more of 100.
  EXPECT_NEAR(error.translation_percent, 1.0, 0.02);
  EXPECT_NEAR(error.rotation_deg_per_m, 0.0, 1e-9);
  EXPECT_GT(error.segments, 300U);
}

TEST(TrajectoryMetrics, ConstantTurnRateErrorIsDegreesPerMetre) {
  std::vector<Pose> truth;
  std::vector<Pose> estimate;
  for (int i = 0; i < 300; ++i) {
    truth.push_back(pose_from_yaw(0.0, {1.0 * i, 0, 0}));
    estimate.push_back(pose_from_yaw(0.001 * i, {1.0 * i, 0, 0}));
  }
  EXPECT_NEAR(kitti_error(estimate, truth).rotation_deg_per_m, 0.001 * 180.0 / M_PI, 1e-3);
}

TEST(TrajectoryMetrics, ShortPathsHaveNoKittiError) {
  EXPECT_EQ(kitti_error(straight(50, 1.0), straight(50, 1.0)).segments, 0U);
  EXPECT_THROW(absolute_error(straight(2, 1.0), straight(3, 1.0)), std::invalid_argument);
  EXPECT_GT(path_length_m(straight(50, 1.0)), 49.0);
}

}  // namespace
}  // namespace loopmark::mapping

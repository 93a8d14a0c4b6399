// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/alignment.hpp"

#include <gtest/gtest.h>

namespace loopmark::odometry {
namespace {

constexpr double kSpacing = 0.3;  // metres between points

/// A square of level ground 1.7 m below the sensor.
std::vector<Eigen::Vector3d> ground() {
  std::vector<Eigen::Vector3d> points;
  for (int i = -30; i <= 30; ++i) {
    for (int j = -30; j <= 30; ++j) {
      points.emplace_back(kSpacing * i + 0.05, kSpacing * j + 0.05, -1.7);
    }
  }
  return points;
}

/// The line that one beam draws on a wall to the left.
std::vector<Eigen::Vector3d> ring(double height_m) {
  std::vector<Eigen::Vector3d> points;
  for (int i = -30; i <= 30; ++i) {
    points.emplace_back(kSpacing * i + 0.05, 8.05, height_m);
  }
  return points;
}

std::vector<Eigen::Vector3f> seen(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3f> result;
  for (const Eigen::Vector3d& point : points) {
    result.push_back(point.cast<float>());
  }
  return result;
}

/// A sensor that comes nearer to a wall sees its beam lower on it: that is no motion downwards, and no roll.
TEST(Alignment, RingsOnWallsDoNotLiftTheSensor) {
  surfels::LocalMap map(1.0, 16);
  std::vector<Eigen::Vector3d> before = ground();
  const std::vector<Eigen::Vector3d> high = ring(2.05);
  before.insert(before.end(), high.begin(), high.end());
  map.insert(before);
  std::vector<Eigen::Vector3d> now = ground();
  const std::vector<Eigen::Vector3d> low = ring(1.9);
  now.insert(now.end(), low.begin(), low.end());
  const Alignment found = align(seen(now), map, Pose::Identity(), 1.0, {});
  const PoseError error = pose_error(found.T_map_lidar, Pose::Identity());
  EXPECT_LT(error.translation_m, 1e-4);
  EXPECT_LT(error.rotation_deg, 1e-3);
  EXPECT_GT(found.tracking_status.inlier_share, 0.9);
}

}  // namespace
}  // namespace loopmark::odometry

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/registration/src/align_to_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopmark::registration {
namespace {

/// Ground that both scans see: a slope of 4 % along x.
double slope(double x) { return 0.04 * x; }

bev::GroundMap target_ground() {
  std::vector<Eigen::Vector3f> points;
  for (double x = -50; x <= 50; x += 0.5) {
    for (double y = -30; y <= 30; y += 0.5) {
      points.emplace_back(Eigen::Vector3d(x, y, slope(x)).cast<float>());
    }
  }
  return bev::GroundMap(points);
}

std::vector<surfels::Surfel> source_ground(const Pose& T_target_source) {
  std::vector<surfels::Surfel> surfels;
  for (double x = -20; x <= 20; x += 1.0) {
    for (double y = -20; y <= 20; y += 1.0) {
      surfels::Surfel surfel;
      surfel.mean = (T_target_source.inverse() * Eigen::Vector3d(x + 15.0, y, slope(x + 15.0))).cast<float>();
      surfels.push_back(surfel);
    }
  }
  return surfels;
}

TEST(Settled, LiftsAndTiltsOntoTheGround) {
  Vector6d xi = Vector6d::Zero();
  xi << 15.0, 2.0, 0.9, 0.02, -0.04, 0.7;
  const Pose truth = exp_se3(xi);
  const double yaw = std::atan2(truth.linear()(1, 0), truth.linear()(0, 0));
  const Pose flat = pose_from_yaw(yaw, {truth.translation().x(), truth.translation().y(), 0.0});
  const PoseError error = pose_error(internal::align_to_ground(flat, source_ground(truth), target_ground()), truth);
  EXPECT_LT(error.translation_m, 0.15);
  EXPECT_LT(error.rotation_deg, 0.6);
  EXPECT_GT(pose_error(flat, truth).translation_m, 0.5);
}

TEST(Settled, LeavesAMotionAloneWhereNoGroundIsShared) {
  const Pose far = pose_from_yaw(0.3, {200.0, 0.0, 0.0});
  EXPECT_EQ(internal::align_to_ground(far, source_ground(Pose::Identity()), target_ground()).matrix(), far.matrix());
}

}  // namespace
}  // namespace loopmark::registration

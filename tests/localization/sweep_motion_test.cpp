// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/localization/src/sweep_motion.hpp"

#include <gtest/gtest.h>

#include "loopmark/cloud/voxel.hpp"
#include "support/box_world.hpp"

namespace loopmark::localization {
namespace {

using testing_support::BoxWorld;

surfels::LocalMap map_of(const BoxWorld& world) {
  surfels::LocalMap map(1.0, 16);
  for (double x = 40.0; x <= 80.0; x += 4.0) {
    const Pose pose = pose_from_yaw(0.0, {x, 0.0, 1.8});
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3f& p : testing_support::sweep(world, pose, Vector6d::Zero()).points) {
      points.push_back(pose * p.cast<double>());
    }
    map.insert(points);
  }
  return map;
}

TEST(SweepMotion, FindsPoseAndMotionOfOneDistortedSweep) {
  const BoxWorld world = testing_support::street(120.0, 6);
  const surfels::LocalMap map = map_of(world);
  const Vector6d velocity = (Vector6d() << 14.0, 0.0, 0.0, 0.0, 0.0, 0.3).finished();
  const Pose truth = pose_from_yaw(0.1, {60.0, 0.5, 1.8});
  const PointCloud seen = testing_support::sweep(world, truth, velocity, 0.01, 1);
  const PointCloud thin = select(seen, cloud::voxel_first_indices(seen.points, 0.7F));
  const Pose start = truth * pose_from_yaw(0.02, {0.5, -0.2, 0.0});
  const auto found = internal::align_sweep(thin.points, thin.time_offset_s, map, start);
  ASSERT_TRUE(found);
  const PoseError error = pose_error(found->T_map_lidar, truth);
  EXPECT_LT(error.translation_m, 0.15);
  EXPECT_LT(error.rotation_deg, 0.5);
  EXPECT_NEAR(found->velocity[0], 14.0, 1.5);
  EXPECT_NEAR(found->velocity[5], 0.3, 0.1);
}

TEST(SweepMotion, AStandingSensorDoesNotMove) {
  const BoxWorld world = testing_support::street(120.0, 6);
  const Pose truth = pose_from_yaw(0.0, {58.0, -0.5, 1.8});
  const PointCloud seen = testing_support::sweep(world, truth, Vector6d::Zero(), 0.01, 2);
  const PointCloud thin = select(seen, cloud::voxel_first_indices(seen.points, 0.7F));
  const auto found = internal::align_sweep(thin.points, thin.time_offset_s, map_of(world), truth);
  ASSERT_TRUE(found);
  EXPECT_LT(found->velocity.head<3>().norm(), 1.0);
  EXPECT_LT(pose_error(found->T_map_lidar, truth).translation_m, 0.1);
}

TEST(SweepMotion, WhereTheMapIsEmptyThereIsNoAnswer) {
  const surfels::LocalMap map(1.0, 16);
  EXPECT_FALSE(internal::align_sweep({{1.0F, 2.0F, 3.0F}}, {0.0F}, map, Pose::Identity()));
}

}  // namespace
}  // namespace loopmark::localization

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"
#include "small_town.hpp"

namespace loopmark::simulation {
namespace {

Ray ray_from(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float moment = 0.5F) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction.normalized();
  ray.range_m = 200.0F;
  ray.moment = moment;
  return ray;
}

TEST(World, RaysMeetAPlaneWhereGeometrySays) {
  const World world(flat_ground(500.0));
  Rng rng(1);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) {
    rays.push_back(ray_from({0, 0, 2}, {static_cast<float>(rng.normal()), static_cast<float>(rng.normal()),
                                        static_cast<float>(rng.normal())}));
  }
  const std::vector<Ray> before = rays;
  world.cast(rays, nullptr);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double expected = -2.0 / before[i].direction.z();
    EXPECT_EQ(rays[i].hit, before[i].direction.z() < 0.0F && expected <= 200.0);
    if (rays[i].hit) {
      EXPECT_NEAR(rays[i].range_m, expected, 1e-4 * expected);
      EXPECT_NEAR(std::abs(rays[i].normal.z()), 1.0, 1e-6);
    }
  }
}

TEST(World, RaysMeetTheNearSideOfABox) {
  Mesh mesh;
  add_box(mesh, pose_from_yaw(0.3, {5.0, 0.0, 0.0}), {-1, -1, -1}, {1, 1, 1}, {});
  const World world(mesh);
  const Pose T_box_world = pose_from_yaw(0.3, {5.0, 0.0, 0.0}).inverse();
  std::vector<Ray> rays = {ray_from({0, 0, 0}, {1, 0.05F, 0.02F}), ray_from({0, 0, 0}, {-1, 0, 0})};
  world.cast(rays, nullptr);
  ASSERT_TRUE(rays[0].hit);
  EXPECT_FALSE(rays[1].hit);
  const Eigen::Vector3d hit = T_box_world * (rays[0].range_m * rays[0].direction).cast<double>();
  EXPECT_NEAR(hit.x(), -1.0, 1e-5);
  EXPECT_LE(hit.tail<2>().cwiseAbs().maxCoeff(), 1.0);
}

TEST(World, MovingBodiesAreMetWhereTheyAreAtThatMoment) {
  const World world(flat_ground(1.0));
  MovingBody van;
  van.shape = 3;
  van.T_world_body_start = pose_from_yaw(0.0, {10.0, 0.0, 0.0});
  van.T_world_body_end = pose_from_yaw(0.0, {12.0, 0.0, 0.0});
  const auto moving = world.place({van});
  std::vector<Ray> rays;
  for (const float moment : {0.0F, 0.5F, 1.0F}) {
    rays.push_back(ray_from({0, 0, 1.5F}, {1, 0, 0}, moment));
  }
  world.cast(rays, moving.get());
  ASSERT_TRUE(rays[0].hit && rays[1].hit && rays[2].hit);
  EXPECT_NEAR(rays[1].range_m - rays[0].range_m, 1.0, 1e-4);
  EXPECT_NEAR(rays[2].range_m - rays[0].range_m, 2.0, 1e-4);
}

TEST(World, LeavesTheNumberOfThreadsAlone) {
  const std::size_t before = thread_count();
  set_thread_count(2);
  const World world(flat_ground(1.0));
  EXPECT_EQ(thread_count(), 2U);
  set_thread_count(before);
}

TEST(World, OtherDaysHaveOtherParkedCars) {
  const World first(small_town(), 1);
  const World again(small_town(), 1);
  const World second(small_town(), 2);
  EXPECT_EQ(first.triangles(), again.triangles());
  EXPECT_NE(first.triangles(), second.triangles());
  EXPECT_GT(first.triangles(), small_town().mesh.size());
}

}  // namespace
}  // namespace loopmark::simulation

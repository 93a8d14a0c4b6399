// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "loopmark/core/parallel.hpp"
#include "small_town.hpp"

namespace loopmark::simulation {
namespace {

DriveOptions moving_drive(int vehicles) {
  DriveOptions o;
  o.length_m = 120.0;
  o.halt_every_m = 0.0;
  o.sensor = "hdl32e";
  o.vehicles = vehicles;
  o.pedestrians = vehicles;
  return o;
}

TEST(Sweep, IsTheSameAtAnyNumberOfThreads) {
  const Drive drive(small_town(), moving_drive(20));
  const std::size_t before = thread_count();
  set_thread_count(1);
  const Scan one = render_scan(small_world(), drive, 5);
  set_thread_count(2);
  const Scan two = render_scan(small_world(), drive, 5);
  set_thread_count(before);
  EXPECT_EQ(one.cloud.points, two.cloud.points);
  EXPECT_EQ(one.cloud.intensity, two.cloud.intensity);
  EXPECT_EQ(one.cloud.time_offset_s, two.cloud.time_offset_s);
  EXPECT_EQ(one.cloud.ring, two.cloud.ring);
  EXPECT_GT(one.cloud.size(), 20000U);
}

TEST(Sweep, RawPointsMovedByTheTruthAreTheCompensatedOnes) {
  const Drive drive(small_town(), moving_drive(20));
  const std::size_t i = drive.size() / 2;
  const Scan raw = render_scan(small_world(), drive, i, Motion::kRaw);
  const Scan still = render_scan(small_world(), drive, i, Motion::kCompensated);
  ASSERT_EQ(raw.cloud.size(), still.cloud.size());
  ASSERT_GT(drive.speed(raw.stamp_s), 2.0);
  const Pose T_stamp_world = drive.pose(raw.stamp_s).inverse();
  double moved = 0.0;
  for (std::size_t k = 0; k < raw.cloud.size(); ++k) {
    const Pose T_world_moment = drive.pose(raw.stamp_s + raw.cloud.time_offset_s[k]);
    const Eigen::Vector3d p = T_stamp_world * (T_world_moment * raw.cloud.points[k].cast<double>());
    ASSERT_LT((p - still.cloud.points[k].cast<double>()).norm(), 1e-3);
    moved = std::max(moved, static_cast<double>((raw.cloud.points[k] - still.cloud.points[k]).norm()));
  }
  EXPECT_GT(moved, 0.1);
}

TEST(Sweep, DeskewedPointsLieOnTheMesh) {
  const Drive drive(small_town(), moving_drive(0));
  const std::size_t i = drive.size() / 2;
  const Scan scan = render_scan(small_world(), drive, i);
  std::vector<Ray> rays;
  std::vector<float> seen;
  for (std::size_t k = 0; k < scan.cloud.size(); k += 7) {
    const Pose T_world_moment = drive.pose(scan.stamp_s + scan.cloud.time_offset_s[k]);
    Ray ray;
    ray.origin = T_world_moment.translation().cast<float>();
    ray.direction = (T_world_moment.linear() * scan.cloud.points[k].cast<double>().normalized()).cast<float>();
    ray.range_m = 150.0F;
    rays.push_back(ray);
    seen.push_back(scan.cloud.points[k].norm());
  }
  small_world().cast(rays, nullptr);
  std::vector<float> errors;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (seen[k] > 3.0F) {  // nearer ones may be the car's own body
      errors.push_back(std::abs(rays[k].range_m - seen[k]));
    }
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.03F);
  EXPECT_LT(errors[errors.size() * 97 / 100], 0.20F);  // the rest grazes edges
}

TEST(Sweep, LooksLikeAStreet) {
  const Drive drive(small_town(), moving_drive(20));
  const Scan scan = render_scan(small_world(), drive, drive.size() / 2);
  std::size_t ground = 0;
  std::size_t high = 0;
  for (const Eigen::Vector3f& p : scan.cloud.points) {
    ground += p.head<2>().norm() < 15.0F && std::abs(p.z() + 1.84F) < 0.6F ? 1 : 0;
    high += p.z() > 0.5F ? 1 : 0;
  }
  EXPECT_GT(ground, scan.cloud.size() / 5);
  EXPECT_GT(high, scan.cloud.size() / 20);
}

}  // namespace
}  // namespace loopmark::simulation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/ground_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "loopmark/core/random.hpp"

namespace loopmark::bev {
namespace {

/// Ground 1.7 m below the sensor, turned by `tilt`, and a bank of `bank` points that rises at 32 degrees.
std::vector<Eigen::Vector3f> scene(double tilt_rad, int ground, int bank) {
  Rng rng(3);
  const Eigen::Isometry3f T(Eigen::AngleAxisf(static_cast<float>(tilt_rad), Eigen::Vector3f::UnitX()));
  const auto noise = [&] { return 0.02 * rng.normal(); };
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < ground; ++i) {
    points.emplace_back(T * Eigen::Vector3d(rng.uniform(-28, 4), rng.uniform(-20, 20), -1.7 + noise()).cast<float>());
  }
  for (int i = 0; i < bank; ++i) {
    const double x = rng.uniform(4, 20);
    const double z = -1.7 + (x - 4) * std::tan(32.0 * std::numbers::pi / 180.0);
    points.emplace_back(T * Eigen::Vector3d(x, rng.uniform(-20, 20), z + noise()).cast<float>());
  }
  return points;
}

double tilt_left_deg(const GroundAlignment& ground_alignment, double tilt_rad) {
  const Eigen::Vector3d up =
      ground_alignment.T_level_sensor.linear() * Eigen::Vector3d(0, -std::sin(tilt_rad), std::cos(tilt_rad));
  return std::acos(std::min(1.0, up.z())) * 180.0 / std::numbers::pi;
}

TEST(GroundAlignment, FindsTheGroundOfATiltedSensor) {
  for (const double tilt_deg : {-10.0, 0.0, 4.0, 10.0}) {
    const double tilt = tilt_deg * std::numbers::pi / 180.0;
    const GroundAlignment ground_alignment = find_ground_alignment(scene(tilt, 1500, 300));
    ASSERT_TRUE(ground_alignment.found);
    EXPECT_LT(tilt_left_deg(ground_alignment, tilt), 0.3) << tilt_deg;
    EXPECT_NEAR(ground_alignment.T_level_sensor.translation().z(), 1.7, 0.1) << tilt_deg;
  }
}

TEST(GroundAlignment, ALargerBankIsNotTakenForTheGround) {
  EXPECT_LT(tilt_left_deg(find_ground_alignment(scene(0.0, 900, 1400)), 0.0), 1.0);
}

/// A street of 9 m on a bridge or a bank: more than half of what is seen lies below it.
TEST(GroundAlignment, LandBesideABridgeDoesNotHideItsDeck) {
  Rng rng(5);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 600; ++i) {
    points.emplace_back(rng.uniform(-28, 28), rng.uniform(-4.5, 4.5), -1.7 + 0.02 * rng.normal());
  }
  for (int i = 0; i < 900; ++i) {
    const double side = rng.uniform() < 0.5 ? 1.0 : -1.0;
    points.emplace_back(rng.uniform(-28, 28), side * rng.uniform(11, 28), rng.uniform(-8.0, -4.0));
  }
  const GroundAlignment ground_alignment = find_ground_alignment(points);
  ASSERT_TRUE(ground_alignment.found);
  EXPECT_LT(tilt_left_deg(ground_alignment, 0.0), 0.5);
  EXPECT_NEAR(ground_alignment.T_level_sensor.translation().z(), 1.7, 0.1);
}

}  // namespace
}  // namespace loopmark::bev

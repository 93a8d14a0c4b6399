// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "loopmark/core/error.hpp"
#include "loopmark/simulation/sweep.hpp"
#include "small_town.hpp"

namespace loopmark::simulation {
namespace {

TEST(Sensor, LasersAreAsManyAsTheNameSaysAndRise) {
  const std::map<std::string, std::size_t> lasers = {{"hdl64e", 64}, {"hdl32e", 32}, {"vlp16", 16}, {"os1-64", 64}};
  for (const std::string& name : sensor_names()) {
    const SensorModel sensor = sensor_model(name);
    EXPECT_EQ(sensor.elevation_rad.size(), lasers.at(name));
    EXPECT_EQ(sensor.fire_offset_s.size(), lasers.at(name));
    EXPECT_TRUE(std::is_sorted(sensor.elevation_rad.begin(), sensor.elevation_rad.end()));
    const double column_s = 1.0 / (sensor.rate_hz * sensor.columns);
    EXPECT_LT(*std::max_element(sensor.fire_offset_s.begin(), sensor.fire_offset_s.end()), column_s);
  }
  EXPECT_NEAR(sensor_model("vlp16").elevation_rad.front() * 180.0 / std::numbers::pi, -15.0, 1e-9);
  EXPECT_NEAR(sensor_model("hdl64e").elevation_rad.back() * 180.0 / std::numbers::pi, 2.0, 1e-9);
}

TEST(Sensor, UnknownNamesAreRefused) { EXPECT_THROW(sensor_model("hdl128"), InputError); }

TEST(Sensor, FasterSpinsHaveFewerColumns) {
  const SensorModel sensor = sensor_model("hdl32e");
  EXPECT_EQ(sensor.at_rate(20.0).columns * 2, sensor.columns);
}

TEST(Sensor, DetectionFallsWithRangeAndIncidenceAndRisesWithReflectance) {
  const SensorModel sensor = sensor_model("hdl64e");
  EXPECT_NEAR(detection_probability(sensor, 0.1, 1.0, sensor.reach_10_m), 0.5, 0.01);
  EXPECT_GT(detection_probability(sensor, 0.3, 1.0, 40.0), detection_probability(sensor, 0.3, 1.0, 80.0));
  EXPECT_GT(detection_probability(sensor, 0.3, 1.0, 60.0), detection_probability(sensor, 0.3, 0.1, 60.0));
  EXPECT_GT(detection_probability(sensor, 0.5, 1.0, 80.0), detection_probability(sensor, 0.1, 1.0, 80.0));
  EXPECT_GT(reflectance({Material::kSign, 128}, 0.7), reflectance({Material::kAsphalt, 128}, 0.7));
}

TEST(Sensor, RingsOnLevelGroundAreCirclesOfTheLasersElevation) {
  const World world(flat_ground(200.0));
  SensorModel sensor = sensor_model("hdl64e");
  sensor.ego.clear();
  const double height = sensor.height_m;
  const PointCloud cloud = render_standing(world, nullptr, sensor, pose_from_yaw(0.4, {1.0, 2.0, height}), 1);
  ASSERT_GT(cloud.size(), 40000U);
  double worst = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double expected = height / -std::sin(sensor.elevation_rad[cloud.ring[i]]);
    if (expected < 20.0) {
      worst = std::max(worst, std::abs(cloud.points[i].norm() - expected));
    }
  }
  EXPECT_LT(worst, 6.0 * 0.055);  // six standard deviations of the noise at grazing incidence
}

TEST(Sensor, TimesFollowTheAzimuthAndTheBlockedSectorIsEmpty) {
  const World world(flat_ground(200.0));
  const SensorModel sensor = sensor_model("os1-64");
  const PointCloud cloud = render_standing(world, nullptr, sensor, pose_from_yaw(0.0, {0, 0, sensor.height_m}), 1);
  std::set<std::uint16_t> rings(cloud.ring.begin(), cloud.ring.end());
  EXPECT_GT(rings.size(), 20U);  // the lower half of the lasers meets the ground
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double azimuth = std::atan2(cloud.points[i].y(), cloud.points[i].x());
    EXPECT_NEAR(cloud.time_offset_s[i], -azimuth / (2.0 * std::numbers::pi) * 0.1, 1e-6);
    const bool hidden = std::abs(azimuth) > std::numbers::pi - 0.49 * sensor.blocked_width_rad;
    EXPECT_TRUE(!hidden || cloud.points[i].norm() < 1.0);
  }
}

}  // namespace
}  // namespace loopmark::simulation

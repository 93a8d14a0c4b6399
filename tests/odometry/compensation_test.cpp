// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/compensation.hpp"

#include <gtest/gtest.h>

#include "support/box_world.hpp"

namespace loopmark::odometry {
namespace {

enum class Sweep { kCompensated, kClockwise, kCounterClockwise };

/// Ten scans of a drive through a street at `speed` metres a second.
std::vector<Scan> drive(double speed, Sweep kind, bool with_times) {
  const testing_support::BoxWorld world = testing_support::street(60.0, 5);
  Vector6d velocity = Vector6d::Zero();
  velocity[0] = speed;
  velocity[5] = speed > 0.0 ? 0.5 : 0.0;  // house fronts along the road show no motion along it
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < 10; ++i) {
    const Pose T_world_lidar = pose_from_yaw(0.0, {10.0, 0.0, 1.7}) * exp_se3(0.1 * static_cast<double>(i) * velocity);
    // Driving time backwards turns a clockwise sweep into one the other way round.
    const Vector6d seen = kind == Sweep::kCompensated ? Vector6d::Zero().eval()
                          : kind == Sweep::kClockwise ? velocity
                                                      : (-velocity).eval();
    PointCloud cloud = testing_support::sweep(world, T_world_lidar, seen, 0.02, i);
    if (!with_times) {
      cloud.time_offset_s.clear();
    } else if (kind == Sweep::kCounterClockwise) {
      for (float& offset : cloud.time_offset_s) {
        offset = -offset;
      }
    }
    scans.push_back({i, 0.1 * static_cast<double>(i), cloud});
  }
  return scans;
}

std::string summary(const CompensationMeasurement& m) {
  std::string text = m.reason + " " + std::to_string(m.sigmas) + " sigma";
  for (const CompensationTrial& trial : m.trials) {
    text += std::string("; ") + compensation_name(trial.assumption) + " " + std::to_string(trial.residual_m);
  }
  return text;
}

CompensationMeasurement measure(const std::vector<Scan>& scans) {
  std::vector<std::size_t> window;
  for (const Scan& scan : scans) {
    window.push_back(scan.index);
  }
  return measure_compensation(
      {window}, [&](std::size_t i) { return scans[i]; }, !scans.front().cloud.time_offset_s.empty());
}

/// In a world as small and coarse as this one the measurement may abstain; what it says must be right.
void expect_nothing_wrong(const std::vector<Scan>& scans, Compensation truth) {
  const CompensationMeasurement measurement = measure(scans);
  EXPECT_TRUE(measurement.verdict == truth || measurement.verdict == Compensation::kUnknown) << summary(measurement);
  EXPECT_EQ(measurement.verdict == Compensation::kUnknown, !measurement.reason.empty());
  EXPECT_GT(measurement.speed_m_s, 4.0);
}

TEST(Compensation, NoDirectionIsTakenForAnother) {
  expect_nothing_wrong(drive(5.0, Sweep::kCompensated, false), Compensation::kCompensated);
  expect_nothing_wrong(drive(5.0, Sweep::kClockwise, false), Compensation::kRawClockwise);
  expect_nothing_wrong(drive(5.0, Sweep::kCounterClockwise, false), Compensation::kRawCounterClockwise);
}

TEST(Compensation, TimesInTheLogDoNotMeanThatItIsRaw) {
  expect_nothing_wrong(drive(5.0, Sweep::kCompensated, true), Compensation::kCompensated);
  expect_nothing_wrong(drive(5.0, Sweep::kClockwise, true), Compensation::kRawGivenTimes);
}

TEST(Compensation, AStandingSensorTellsNothing) {
  const CompensationMeasurement standing = measure(drive(0.0, Sweep::kClockwise, false));
  EXPECT_EQ(standing.verdict, Compensation::kUnknown);
  EXPECT_FALSE(standing.reason.empty());
  EXPECT_EQ(measure_compensation({}, {}, false).verdict, Compensation::kUnknown);
}

}  // namespace
}  // namespace loopmark::odometry

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/odometry.hpp"

#include <gtest/gtest.h>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "support/box_world.hpp"

namespace loopmark::odometry {
namespace {

using testing_support::BoxWorld;

/// A drive along a street at a constant speed with a gentle turn rate.
struct Drive {
  BoxWorld world = testing_support::street(120.0, 5);
  Vector6d velocity = (Vector6d() << 10.0, 0.0, 0.0, 0.0, 0.0, 0.05).finished();

  Pose pose(double time_s) const { return pose_from_yaw(-0.05, {0.0, 0.0, 1.8}) * exp_se3(time_s * velocity); }
  Scan scan(std::size_t index, double time_s) const {
    return {index, time_s, testing_support::sweep(world, pose(time_s), velocity, 0.02, index)};
  }
};

PoseError error_after(const Drive& drive, const std::vector<double>& times, Compensation compensation) {
  Odometry odometry({}, compensation);
  Pose last;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const TrackedScan tracked = odometry.track(drive.scan(i, times[i]));
    EXPECT_NE(tracked.tracking_status.tracking, Tracking::kLost)
        << "scan " << i << ": " << tracked.tracking_status.reason;
    odometry.commit(tracked);
    last = tracked.T_map_lidar;
  }
  return pose_error(last, drive.pose(times.front()).inverse() * drive.pose(times.back()));
}

std::vector<double> every(double step_s, std::size_t count) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) {
    times[i] = step_s * static_cast<double>(i);
  }
  return times;
}

TEST(Odometry, FollowsADriveThatStartsWhileMoving) {
  const Drive drive;
  const PoseError error = error_after(drive, every(0.1, 25), Compensation::kRawClockwise);
  EXPECT_LT(error.translation_m, 0.12);  // of 24 m
  EXPECT_LT(error.rotation_deg, 0.4);
}

/// A car that steers harder and harder: its rate of turn grows by 1 rad/s each second.
TEST(Odometry, KnowsHowTheSensorTurnedDuringASweep) {
  const BoxWorld world = testing_support::street(120.0, 5);
  Odometry odometry({}, Compensation::kRawGivenTimes);
  Pose truth = pose_from_yaw(-0.3, {0.0, 0.0, 1.8});
  double worst_mean = 0.0;  // rad/s by which the mean since the last scan, what it was deskewed with,
  double worst_sweep = 0.0;
  double worst_settled = 0.0;  // and what is known one scan later are off
  for (std::size_t i = 0; i < 10; ++i) {
    const double rate = 0.1 * static_cast<double>(i);
    const Vector6d velocity = (Vector6d() << 8.0, 0.0, 0.0, 0.0, 0.0, rate).finished();
    const TrackedScan tracked = odometry.track({i, rate, testing_support::sweep(world, truth, velocity, 0.01, i)});
    if (i > 2) {
      worst_mean = std::max(worst_mean, std::abs(tracked.velocity[5] - rate));
      worst_sweep = std::max(worst_sweep, std::abs(tracked.sweep_velocity[5] - rate));
      worst_settled = std::max(worst_settled, std::abs(odometry.sweep_of_last(tracked)[5] - (rate - 0.1)));
    }
    odometry.commit(tracked);
    truth = truth * exp_se3(0.1 * (Vector6d() << 8.0, 0.0, 0.0, 0.0, 0.0, rate + 0.05).finished());
  }
  EXPECT_NEAR(worst_mean, 0.05, 0.03);  // half a scan behind
  EXPECT_LT(worst_sweep, 0.03);
  EXPECT_LT(worst_settled, 0.015);
}

/// Metres by which the odometry misses a straight drive of ten scans over open land that it begins at speed.
double miss_on_open_land(double speed, double rate_hz, std::uint64_t seed) {
  constexpr int kBeams = 16;
  constexpr std::size_t kScans = 10;
  const BoxWorld world = testing_support::open_land(150.0, 15.0, seed);
  const Vector6d velocity = (Vector6d() << speed, 0.0, 0.0, 0.0, 0.0, 0.01).finished();
  Odometry odometry({}, Compensation::kRawClockwise);
  Pose last;
  Pose truth;
  for (std::size_t i = 0; i < kScans; ++i) {
    const double time_s = static_cast<double>(i) / rate_hz;
    truth = exp_se3(time_s * velocity);
    const Pose T_world_lidar = pose_from_yaw(0.02, {0.0, 0.0, 1.8}) * truth;
    const TrackedScan tracked = odometry.track(
        {i, time_s, testing_support::sweep(world, T_world_lidar, velocity, 0.02, 100 * seed + i, kBeams)});
    odometry.commit(tracked);
    last = tracked.T_map_lidar;
  }
  return pose_error(last, truth).translation_m;
}

TEST(Odometry, BelievesPostsNotTheRingsOfTheGroundWhereItStartsAtSpeed) {
  for (const double speed : {10.0, 14.0}) {
    for (const double rate_hz : {10.0, 5.0}) {
      const double driven_m = 9.0 / rate_hz * speed;
      for (const std::uint64_t seed : {1, 2}) {
        EXPECT_LT(miss_on_open_land(speed, rate_hz, seed), 0.3 + 0.03 * driven_m)
            << speed << " m/s, " << rate_hz << " scans a second, world " << seed;
      }
    }
  }
}

TEST(Odometry, StampsThatRepeatAreNoEndOfThePath) {
  const Drive drive;
  Odometry odometry({}, Compensation::kCompensated);
  Pose last;
  for (std::size_t i = 0; i < 12; ++i) {
    const Pose pose = drive.pose(0.1 * static_cast<double>(i));
    const Scan scan{i, i == 7 ? 0.6 : 0.1 * static_cast<double>(i),
                    testing_support::sweep(drive.world, pose, Vector6d::Zero(), 0.02, i)};
    const TrackedScan tracked = odometry.track(scan);
    EXPECT_TRUE(tracked.velocity.allFinite());
    odometry.commit(tracked);
    last = tracked.T_map_lidar;
  }
  EXPECT_LT(pose_error(last, drive.pose(0.0).inverse() * drive.pose(1.1)).translation_m, 0.12);
}

TEST(Odometry, TimesGivenOrRebuiltFromTheAzimuthAreTheSame) {
  const Drive drive;
  const PoseError given = error_after(drive, every(0.1, 12), Compensation::kRawGivenTimes);
  const PoseError rebuilt = error_after(drive, every(0.1, 12), Compensation::kRawClockwise);
  EXPECT_NEAR(given.translation_m, rebuilt.translation_m, 2e-3);
}

TEST(Odometry, BridgesDroppedScans) {
  std::vector<double> times = every(0.1, 20);
  times.erase(times.begin() + 8, times.begin() + 12);
  const PoseError error = error_after(Drive{}, times, Compensation::kRawClockwise);
  EXPECT_LT(error.translation_m, 0.1);
}

TEST(Odometry, SaysThatItIsLostInAnotherPlace) {
  const Drive drive;
  Odometry odometry({}, Compensation::kRawClockwise);
  for (std::size_t i = 0; i < 6; ++i) {
    odometry.commit(odometry.track(drive.scan(i, 0.1 * static_cast<double>(i))));
  }
  Drive elsewhere;
  elsewhere.world = testing_support::street(120.0, 77);
  const TrackedScan tracked = odometry.track(elsewhere.scan(6, 6.6));
  EXPECT_EQ(tracked.tracking_status.tracking, Tracking::kLost);
  EXPECT_FALSE(tracked.tracking_status.reason.empty());
  odometry.restart();
  EXPECT_EQ(odometry.track(elsewhere.scan(6, 6.6)).tracking_status.tracking, Tracking::kGood);
}

TEST(Odometry, WidensAlongACorridorWithoutFeatures) {
  BoxWorld corridor;
  corridor.boxes = {{{-500, 4, 0}, {500, 6, 8}}, {{-500, -6, 0}, {500, -4, 8}}};
  Odometry odometry({}, Compensation::kCompensated);
  TrackedScan tracked;
  for (std::size_t i = 0; i < 3; ++i) {
    const Pose pose = pose_from_yaw(0.0, {0.3 * static_cast<double>(i), 0.0, 1.8});
    tracked = odometry.track(
        {i, 0.1 * static_cast<double>(i), testing_support::sweep(corridor, pose, Vector6d::Zero(), 0.02, i)});
    odometry.commit(tracked);
  }
  ASSERT_EQ(tracked.tracking_status.degenerate_directions.size(), 1U);
  EXPECT_GT(std::abs(tracked.tracking_status.degenerate_directions[0].x()), 0.98);
  EXPECT_GT(tracked.tracking_status.covariance(0, 0), 25.0 * tracked.tracking_status.covariance(1, 1));
}

TEST(Odometry, TheSameBytesAtAnyNumberOfThreads) {
  const auto run = [](std::size_t threads) {
    set_thread_count(threads);
    const Drive drive;
    Odometry odometry({}, Compensation::kRawClockwise);
    Pose last;
    for (std::size_t i = 0; i < 6; ++i) {
      const TrackedScan tracked = odometry.track(drive.scan(i, 0.1 * static_cast<double>(i)));
      odometry.commit(tracked);
      last = tracked.T_map_lidar;
    }
    return last;
  };
  const Pose one = run(1);
  const Pose two = run(2);
  set_thread_count(0);
  EXPECT_TRUE(one.matrix() == two.matrix());
}

TEST(Odometry, GoesOnFromItsSavedState) {
  const Drive drive;
  Odometry whole({}, Compensation::kRawClockwise);
  Odometry second({}, Compensation::kRawClockwise);
  for (std::size_t i = 0; i < 8; ++i) {
    if (i == 5) {
      second.set_state(whole.state());
    }
    const Scan scan = drive.scan(i, 0.1 * static_cast<double>(i));
    whole.commit(whole.track(scan));
    if (i >= 5) {
      second.commit(second.track(scan));
    }
  }
  const Scan next = drive.scan(8, 0.8);
  EXPECT_TRUE(whole.track(next).T_map_lidar.matrix() == second.track(next).T_map_lidar.matrix());
  std::string damaged = whole.state();
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_THROW(second.set_state(damaged), InputError);
  EXPECT_THROW(second.set_state("short"), InputError);
}

TEST(Odometry, EmptyAndDamagedCloudsAreLostNotFatal) {
  Odometry odometry({}, Compensation::kCompensated);
  const Drive drive;
  odometry.commit(odometry.track(drive.scan(0, 0.0)));
  EXPECT_EQ(odometry.track({1, 0.1, {}}).tracking_status.tracking, Tracking::kLost);
  PointCloud nonsense;
  nonsense.points.assign(100, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(odometry.track({1, 0.1, nonsense}).tracking_status.tracking, Tracking::kLost);
}

TEST(Odometry, RefusesSenselessOptions) {
  OdometryOptions options;
  options.max_range_m = 0.1;
  EXPECT_THROW(Odometry{options}, InputError);
}

}  // namespace
}  // namespace loopmark::odometry

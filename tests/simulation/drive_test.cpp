// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/drive.hpp"

#include <gtest/gtest.h>

#include <map>

#include "loopmark/core/error.hpp"
#include "small_town.hpp"

namespace loopmark::simulation {
namespace {

DriveOptions options(const std::string& route, double length) {
  DriveOptions o;
  o.route = route;
  o.length_m = length;
  return o;
}

TEST(Drive, ToursComeBackInEveryWay) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Town town = make_town({seed, 6, 5, 0.06});
    const Drive drive(town, options("tour", 1500.0));
    std::map<RevisitKind, int> counts;
    for (const Revisit& r : drive.revisits()) {
      ++counts[r.kind];
      EXPECT_LT(r.earlier_end_m, r.end_m);
      EXPECT_LE(r.nearest_m, 8.0);
    }
    EXPECT_GE(drive.revisits().size(), 6U) << "town " << seed;
    EXPECT_GE(counts[RevisitKind::kOpposite], 2) << "town " << seed;
    EXPECT_GE(counts[RevisitKind::kCrossing], 1) << "town " << seed;
    EXPECT_GE(counts[RevisitKind::kSame], 1) << "town " << seed;
  }
}

TEST(Traffic, NobodyTurnsRoundWithinASweep) {
  const Drive drive(small_town(), options("tour", 300.0));
  std::size_t seen = 0;
  for (double t = 0.0; t < 300.0; t += 0.1) {  // long enough for every walker to turn round
    for (const MovingBody& body : drive.traffic().bodies(t, t + 0.1, drive.pose(0.0), 1000.0)) {
      const PoseError moved = pose_error(body.T_world_body_end, body.T_world_body_start);
      ASSERT_LT(moved.translation_m, 3.0);
      ASSERT_LT(moved.rotation_deg, 50.0) << "its matrices have no inverse half way";
      ++seen;
    }
  }
  EXPECT_GT(seen, 10000U);
}

TEST(Drive, TwinsRunsAlongBlocksThatLookAlike) {
  const Drive drive(small_town(), options("twins", 500.0));
  std::size_t alike = 0;
  for (const int edge : drive.path().edge) {
    alike += small_town().roads.edges[edge].near_identical ? 1 : 0;
  }
  EXPECT_GT(5 * alike, 2 * drive.path().edge.size());
}

TEST(Drive, MovesSmoothlyOnStreetsOfBoundedSlope) {
  const Drive drive(small_town(), options("tour", 800.0));
  EXPECT_NEAR(drive.distance(drive.stamp_s(drive.size() - 1)), 800.0, 12.0);
  EXPECT_GT(drive.speed(0.0), 1.0);  // it starts while moving
  double halted = 0.0;
  for (double t = 0.05; t < drive.stamp_s(drive.size() - 1); t += 0.05) {
    const Pose a = drive.pose(t - 0.05);
    const Pose b = drive.pose(t);
    const PoseError step = pose_error(b, a);
    EXPECT_LT(step.translation_m, 0.05 * 18.0);
    EXPECT_LT(step.rotation_deg, 0.05 * 75.0);
    EXPECT_GE(drive.distance(t), drive.distance(t - 0.05));
    EXPECT_GT(b.linear()(2, 2), std::cos(std::atan(0.065) + 0.03));
    halted += drive.speed(t) < 0.01 ? 0.05 : 0.0;
  }
  EXPECT_GT(halted, 0.5);
}

TEST(Drive, ReverseFollowsTheSameStreetsTheOtherWay) {
  DriveOptions o = options("explore", 400.0);
  const Drive there(small_town(), o);
  o.reverse = true;
  o.day = 2;
  const Drive back(small_town(), o);
  std::size_t opposite = 0;
  std::size_t near = 0;
  for (double s = 0.0; s < back.path().length(); s += 2.0) {
    for (double u = 0.0; u < there.path().length(); u += 2.0) {
      if ((there.path().position(u) - back.path().position(s)).norm() < 4.5) {
        ++near;
        opposite += std::cos(there.path().heading(u) - back.path().heading(s)) < -0.9 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(opposite, 60U);
  EXPECT_GT(2 * opposite, near);
}

TEST(Drive, LanesLieBesideEachOther) {
  DriveOptions o = options("explore", 200.0);
  const Drive right(small_town(), o);
  o.lane = Lane::kLeft;
  const Drive left(small_town(), o);
  EXPECT_NEAR((right.path().points.front() - left.path().points.front()).norm(), 3.5, 0.05);
}

TEST(Drive, SenselessOptionsAreRefused) {
  EXPECT_THROW(Drive(small_town(), options("nowhere", 100.0)), InputError);
  EXPECT_THROW(Drive(small_town(), options("tour", -5.0)), InputError);
  DriveOptions o = options("tour", 100.0);
  o.rate_hz = 500.0;
  EXPECT_THROW(Drive(small_town(), o), InputError);
  EXPECT_THROW(make_town({1, 2, 5, 0.06}), InputError);
}

}  // namespace
}  // namespace loopmark::simulation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/kidnap_benchmark/drill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "loopmark/core/error.hpp"
#include "support/box_world.hpp"

namespace loopmark::kidnap_benchmark {
namespace {

// ---- strata ----

TEST(Strata, AreToldByWhatWasMeasured) {
  constexpr double kMedian = 100.0;
  PlaceCharacter place;
  place.structure = 90.0;
  place.same_place = 0.4;
  place.other_place = 0.6;
  EXPECT_EQ(stratum_of(place, kMedian), Stratum::kStraight);
  place.turn_deg = 45.0;
  EXPECT_EQ(stratum_of(place, kMedian), Stratum::kJunction);
  place.turn_deg = 0.0;
  place.crossing = true;
  EXPECT_EQ(stratum_of(place, kMedian), Stratum::kJunction);
  place.structure = 30.0;
  EXPECT_EQ(stratum_of(place, kMedian), Stratum::kOpen);
  place.other_place = 0.39;
  EXPECT_EQ(stratum_of(place, kMedian), Stratum::kNearIdentical);
}

// ---- the plan ----

/// A drive along x at 10 m/s with a scan every 0.1 s; every stratum in turn, 40 scans long.
std::vector<DrillScan> drive(std::size_t count) {
  std::vector<DrillScan> scans;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    scans.push_back({i, 0.1 * x, pose_from_yaw(0.0, {x, 0.0, 0.0}), kStrata[i / 40 % 4]});
  }
  return scans;
}

bool same_event(const DrillEvent& a, const DrillEvent& b) {
  return a.number == b.number && a.disturbance == b.disturbance && a.stratum == b.stratum && a.before == b.before &&
         a.after == b.after && a.outage_s == b.outage_s && a.yaw_deg == b.yaw_deg;
}

TEST(DrillPlan, IsEvenOverStrataAndDisturbancesAndWhatItSays) {
  const std::vector<DrillScan> run = drive(900);
  const std::vector<DrillScan> other = drive(300);
  DrillOptions options;
  options.events = 64;
  const std::vector<DrillEvent> events = plan_drill(run, other, options);
  ASSERT_EQ(events.size(), 64U);
  std::set<double> outages;
  for (const Disturbance disturbance :
       {Disturbance::kOutage, Disturbance::kTeleport, Disturbance::kTurned, Disturbance::kOtherDrive}) {
    for (const Stratum stratum : kStrata) {
      EXPECT_EQ(
          std::count_if(events.begin(), events.end(),
                        [&](const DrillEvent& e) { return e.disturbance == disturbance && e.stratum == stratum; }),
          4);
    }
  }
  for (const DrillEvent& e : events) {
    const DrillScan& arrival = (e.disturbance == Disturbance::kOtherDrive ? other : run)[e.after];
    EXPECT_EQ(arrival.stratum, e.stratum);
    EXPECT_GE(run[e.before].stamp_s, options.before_s - 1e-9);
    if (e.disturbance == Disturbance::kOutage) {
      EXPECT_NEAR(arrival.stamp_s - run[e.before].stamp_s, e.outage_s, 1e-9);
      outages.insert(std::round(10.0 * e.outage_s) / 10.0);
    }
    if (e.disturbance == Disturbance::kTeleport) {
      EXPECT_GE((arrival.T_map_lidar.translation() - run[e.before].T_map_lidar.translation()).norm(), 50.0);
    }
    EXPECT_EQ(e.yaw_deg != 0.0, e.disturbance == Disturbance::kTurned);
  }
  EXPECT_GE(outages.size(), 6U);
  EXPECT_LE(*outages.begin(), 0.7);
  EXPECT_GE(*outages.rbegin(), 60.0);
}

TEST(DrillPlan, TheSeedRepeatsItAndAnotherOneDoesNot) {
  const std::vector<DrillScan> run = drive(900);
  DrillOptions options;
  const auto first = plan_drill(run, {}, options);
  const auto again = plan_drill(run, {}, options);
  ASSERT_EQ(first.size(), again.size());
  EXPECT_TRUE(std::equal(first.begin(), first.end(), again.begin(), same_event));
  options.seed = 2;
  const auto other = plan_drill(run, {}, options);
  EXPECT_FALSE(first.size() == other.size() && std::equal(first.begin(), first.end(), other.begin(), same_event));
}

TEST(DrillPlan, OfATooShortRunIsRefused) {
  EXPECT_THROW(plan_drill({}, {}, {}), InputError);
  EXPECT_THROW(plan_drill(drive(5), {}, {}), InputError);
  DrillOptions options;
  options.outages_s = {-1.0};
  EXPECT_THROW(plan_drill(drive(900), {}, options), InputError);
}

// ---- an event ----

/// Knows every scan's true pose, as the drive tells it while it is read; lies where it is told to.
class TellingMap final : public localization::PlaceMap {
 public:
  std::vector<localization::LocalizationHypothesis> search(const PointCloud& /*scan*/, std::size_t /*places*/,
                                                           const std::vector<Pose>& /*believed*/) const override {
    if (silent) {
      return {};
    }
    return {localization::LocalizationHypothesis{lie * truth, 1e-4 * Matrix6d::Identity(), 4.0}};
  }
  std::vector<localization::LocalizationHypothesis> judge(const PointCloud& scan,
                                                          const std::vector<Pose>& believed) const override {
    return search(scan, 0, believed);
  }
  std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& /*position*/, double /*radius*/) const override {
    return points;
  }

  Pose truth = Pose::Identity();
  Pose lie = Pose::Identity();
  bool silent = false;
  std::vector<Eigen::Vector3d> points;
};

class DrillEventTest : public ::testing::Test {
 protected:
  DrillEventTest() {
    const testing_support::BoxWorld world = testing_support::street(120.0, 4);
    for (std::size_t i = 0; i < 100; ++i) {
      const Pose pose = pose_from_yaw(0.0, {static_cast<double>(i), 0.0, 1.8});
      stage_.run.scans.push_back({i, 0.1 * static_cast<double>(i), pose, Stratum::kStraight});
      if (i % 4 == 0) {
        for (const Eigen::Vector3f& p : testing_support::sweep(world, pose, Vector6d::Zero()).points) {
          map_->points.push_back(pose * p.cast<double>());
        }
      }
    }
    stage_.map = map_;
    stage_.run.read = [this, world](std::size_t i) {
      Scan scan;
      scan.index = i;
      scan.stamp_s = stage_.run.scans[i].stamp_s;
      scan.cloud = testing_support::sweep(world, stage_.run.scans[i].T_map_lidar, Vector6d::Zero(), 0.01, i);
      map_->truth = stage_.run.scans[i].T_map_lidar * pose_from_yaw(-yaw_deg_ * M_PI / 180.0);
      return scan;
    };
    event_.before = 15;
    event_.after = 60;
    event_.disturbance = Disturbance::kTeleport;
    event_.outage_s = 0.1;
  }

  std::shared_ptr<TellingMap> map_ = std::make_shared<TellingMap>();
  DrillStage stage_;
  DrillEvent event_;
  double yaw_deg_ = 0.0;
};

TEST_F(DrillEventTest, ATrueMapRecovers) {
  const DrillOutcome outcome = run_event(stage_, event_, {});
  EXPECT_EQ(outcome.verdict, DrillVerdict::kRecovered) << outcome.reason << " " << outcome.error.translation_m;
  EXPECT_TRUE(outcome.tracked_before);
  EXPECT_TRUE(outcome.noticed);
  EXPECT_TRUE(succeeded(outcome, {}));
  EXPECT_LT(outcome.error.translation_m, 0.2);
  EXPECT_LT(outcome.seconds, 1.0);
}

TEST_F(DrillEventTest, ATurnedSensorIsJudgedByItsTurnedPose) {
  yaw_deg_ = 110.0;
  event_.disturbance = Disturbance::kTurned;
  event_.yaw_deg = yaw_deg_;
  event_.outage_s = 4.5;
  const DrillOutcome outcome = run_event(stage_, event_, {});
  EXPECT_EQ(outcome.verdict, DrillVerdict::kRecovered) << outcome.reason << " " << outcome.error.translation_m;
  EXPECT_LT(outcome.error.rotation_deg, 1.0);
}

TEST_F(DrillEventTest, AWrongPoseIsFoundOut) {
  // A copy of the street 60 m beside it, where the scans fit as well as where they were taken.
  const Pose beside = pose_from_yaw(0.0, {0.0, 60.0, 0.0});
  const std::vector<Eigen::Vector3d> street = map_->points;
  for (const Eigen::Vector3d& p : street) {
    map_->points.push_back(beside * p);
  }
  map_->lie = beside;
  const DrillOutcome outcome = run_event(stage_, event_, {});
  EXPECT_EQ(outcome.verdict, DrillVerdict::kWrong) << outcome.reason;
  EXPECT_FALSE(succeeded(outcome, {}));
  EXPECT_NEAR(outcome.error.translation_m, 60.0, 0.5);
  EXPECT_NEAR(outcome.T_map_truth.translation().y(), 0.0, 1e-9);
  EXPECT_NEAR(outcome.T_map_answer.translation().y(), 60.0, 0.5);
}

TEST_F(DrillEventTest, ASilentMapGivesNoPoseAndTheEventEnds) {
  map_->silent = true;
  DrillOptions options;
  options.within_s = 0.5;
  options.limit_s = 1.0;
  const DrillOutcome outcome = run_event(stage_, event_, options);
  EXPECT_EQ(outcome.verdict, DrillVerdict::kNone);
  EXPECT_NEAR(outcome.seconds, 1.0, 0.11);
  EXPECT_FALSE(outcome.reason.empty());
}

}  // namespace
}  // namespace loopmark::kidnap_benchmark

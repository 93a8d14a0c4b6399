// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/relocalizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"
#include "support/box_world.hpp"

namespace loopmark::localization {
namespace {

/// A winding street with houses that all differ, 400 m long; the sensor drives along y = 0.
struct Street {
  std::vector<Eigen::Vector3d> points;

  Street() {
    Rng rng(1);
    for (int side : {-1, 1}) {
      for (double x = -60.0; x < 460.0;) {
        const double width = rng.uniform(3.0, 9.0);
        const double depth = side * rng.uniform(5.0, 11.0);
        const double height = rng.uniform(2.0, 7.0);
        add_box(x, depth, width, height);
        x += width + rng.uniform(0.0, 2.0);
      }
    }
    for (double x = -60.0; x < 460.0; x += 0.5) {
      for (double y = -5.0; y < 5.0; y += 0.5) {
        points.emplace_back(x, y, -1.8);
      }
    }
  }

  void add_box(double x, double depth, double width, double height) {
    for (double z = -1.8; z < height; z += 0.4) {
      for (double s = 0.0; s < width; s += 0.3) {
        points.emplace_back(x + s, depth, z);
      }
      for (double s = 0.0; s < 3.0; s += 0.3) {
        points.emplace_back(x, depth + std::copysign(s, depth), z);
      }
    }
  }

  Scan seen_from(const Pose& T_map_lidar, std::size_t index) const {
    Scan scan;
    scan.index = index;
    scan.stamp_s = 0.1 * static_cast<double>(index);
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d q = T_map_lidar.inverse() * p;
      if (q.norm() < 45.0) {
        scan.cloud.points.push_back(q.cast<float>());
      }
    }
    return scan;
  }
};

/// Answers with the truth about a scan, as told beforehand.
class TellingMap final : public PlaceMap {
 public:
  explicit TellingMap(const Street& street) : street_(street) {}

  std::vector<LocalizationHypothesis> search(const PointCloud& /*scan*/, std::size_t /*places*/,
                                             const std::vector<Pose>& /*believed*/) const override {
    ++searches;
    return answers;
  }
  std::vector<LocalizationHypothesis> judge(const PointCloud& /*scan*/,
                                            const std::vector<Pose>& priors) const override {
    ++verifications;
    return {LocalizationHypothesis{correction * priors.front(), Matrix6d::Identity(), verdict}};
  }
  std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& position, double radius) const override {
    std::vector<Eigen::Vector3d> near;
    for (const Eigen::Vector3d& p : street_.points) {
      if ((p - position).norm() < radius) {
        near.push_back(p);
      }
    }
    return near;
  }

  std::vector<LocalizationHypothesis> answers;
  double verdict = 2.0;                ///< log-odds of whatever pose is believed,
  Pose correction = Pose::Identity();  ///< which is moved by this
  mutable int searches = 0;
  mutable int verifications = 0;

 private:
  const Street& street_;
};

class RelocalizerTest : public ::testing::Test {
 protected:
  RelocalizedScan drive_to(double x, double p) {
    const Pose truth = pose_from_yaw(0.02 * std::sin(x / 20.0), {x, 0.5 * std::sin(x / 30.0), 0.0});
    const Pose prior = truth * pose_from_yaw(0.01, {0.2, -0.1, 0.0});
    map_->answers = p > 0.0
                        ? std::vector<LocalizationHypothesis>{{prior, Matrix6d::Identity(), std::log(p / (1.0 - p))}}
                        : std::vector<LocalizationHypothesis>{};
    truth_ = truth;
    return relocalizer_.add(street_.seen_from(truth, next_++));
  }

  Street street_;
  std::shared_ptr<TellingMap> map_ = std::make_shared<TellingMap>(street_);
  Relocalizer relocalizer_{map_, {}};
  Pose truth_ = Pose::Identity();
  std::size_t next_ = 0;
};

TEST_F(RelocalizerTest, FindsThePlaceThenTracksWithoutSearching) {
  RelocalizedScan answer = drive_to(0.0, 0.95);
  EXPECT_EQ(answer.state, RelocalizationState::kTracking);
  EXPECT_TRUE(answer.answered);
  EXPECT_LT(pose_error(answer.T_map_lidar, truth_).translation_m, 0.15);
  for (double x = 1.0; x < 45.0; x += 1.0) {
    answer = drive_to(x, 0.0);
    ASSERT_EQ(answer.state, RelocalizationState::kTracking) << x << ": " << answer.reason;
    EXPECT_LT(pose_error(answer.T_map_lidar, truth_).translation_m, 0.15) << x;
  }
  EXPECT_EQ(map_->searches, 1);
  EXPECT_GT(map_->verifications, 5) << "every 5 m";
  EXPECT_GT(answer.p_correct, 0.95);
}

TEST_F(RelocalizerTest, GivesUpWhatRegistrationContradicts) {
  for (double x = 0.0; x < 12.0; x += 1.0) {
    ASSERT_EQ(drive_to(x, 0.95).state, RelocalizationState::kTracking) << x;
  }
  map_->verdict = -3.0;
  bool given_up = false;
  for (double x = 12.0; x < 60.0 && !given_up; x += 1.0) {
    const RelocalizedScan answer = drive_to(x, 0.0);
    given_up = answer.given_up;
    EXPECT_TRUE(!given_up ||
                (answer.state == RelocalizationState::kLost && !answer.answered && !answer.reason.empty()));
  }
  EXPECT_TRUE(given_up);
}

TEST_F(RelocalizerTest, TakesThePoseOfRegistrationWhereNearestPointsEndElsewhere) {
  drive_to(0.0, 0.95);
  map_->correction = pose_from_yaw(0.0, {0.8, 0.0, 0.0});
  double largest = 0.0;
  for (double x = 1.0; x < 8.0; x += 1.0) {
    const RelocalizedScan answer = drive_to(x, 0.0);
    ASSERT_EQ(answer.state, RelocalizationState::kTracking);
    largest = std::max(largest, pose_error(answer.T_map_lidar, truth_).translation_m);
  }
  EXPECT_NEAR(largest, 0.8, 0.15) << "the scan that was verified";
  EXPECT_GT(map_->verifications, 0);
}

TEST_F(RelocalizerTest, APlaceToldFromOutsideIsTrackedWithoutASearch) {
  relocalizer_.place(pose_from_yaw(0.0, {20.3, 0.2, 0.0}));
  const RelocalizedScan answer = drive_to(20.0, 0.0);
  EXPECT_EQ(answer.state, RelocalizationState::kTracking);
  EXPECT_LT(pose_error(answer.T_map_lidar, truth_).translation_m, 0.15);
  EXPECT_EQ(map_->searches, 0);
}

TEST_F(RelocalizerTest, AfterALongSilenceThePlaceIsGivenUpAndSearched) {
  for (double x = 0.0; x < 6.0; x += 1.0) {
    ASSERT_EQ(drive_to(x, 0.95).state, RelocalizationState::kTracking) << x;
  }
  next_ += 30;  // 3 s
  const RelocalizedScan answer = drive_to(150.0, 0.95);
  EXPECT_TRUE(answer.given_up);
  EXPECT_EQ(answer.state, RelocalizationState::kTracking) << "found again by the same scan";
  EXPECT_LT(pose_error(answer.T_map_lidar, truth_).translation_m, 0.15);
  EXPECT_EQ(map_->searches, 2);
}

TEST_F(RelocalizerTest, OwnMotionLostWhileSearchingIsNoLossOfAPlace) {
  for (const double x : {0.0, 1.0, 2.0, 200.0}) {
    const RelocalizedScan answer = drive_to(x, 0.0);
    EXPECT_EQ(answer.state, RelocalizationState::kSearching);
    EXPECT_FALSE(answer.given_up);
  }
}

TEST_F(RelocalizerTest, SearchesOnUntilItIsSure) {
  RelocalizedScan answer = drive_to(0.0, 0.3);
  EXPECT_EQ(answer.state, RelocalizationState::kSearching);
  EXPECT_FALSE(answer.answered);
  EXPECT_NEAR(answer.p_correct, 0.3, 1e-9);
  answer = drive_to(0.6, 0.9);
  EXPECT_EQ(map_->searches, 1) << "it hardly moved";
  int scans = 0;
  for (double x = 1.2; answer.state != RelocalizationState::kTracking && scans < 10; x += 0.6, ++scans) {
    answer = drive_to(x, 0.9);
  }
  EXPECT_EQ(answer.state, RelocalizationState::kTracking) << answer.reason << " " << answer.p_correct;
  EXPECT_LT(pose_error(answer.T_map_lidar, truth_).translation_m, 0.15);
}

TEST_F(RelocalizerTest, NoticesThatItIsLostAndFindsItselfAgain) {
  for (double x = 0.0; x < 10.0; x += 1.0) {
    ASSERT_EQ(drive_to(x, 0.95).state, RelocalizationState::kTracking) << x;
  }
  // Carried off: nothing looks right for a while.
  bool lost = false;
  std::size_t wrong = 0;
  for (double x = 200.0; x < 210.0; x += 1.0) {
    const RelocalizedScan answer = drive_to(x, 0.0);
    lost = lost || answer.given_up;
    wrong += answer.answered && pose_error(answer.T_map_lidar, truth_).translation_m > 0.6 ? 1 : 0;
  }
  EXPECT_TRUE(lost);
  EXPECT_LE(wrong, 2U);
  RelocalizedScan answer;
  for (double x = 210.0; x < 216.0; x += 1.5) {
    answer = drive_to(x, 0.95);
  }
  EXPECT_EQ(answer.state, RelocalizationState::kTracking);
  EXPECT_LT(pose_error(answer.T_map_lidar, truth_).translation_m, 0.15);
}

/// A street whose houses come again every 60 m: tracking cannot tell one stretch from the next.
class AlikeStretchesTest : public ::testing::Test {
 protected:
  static constexpr double kPeriod = 60.0;

  AlikeStretchesTest() {
    const std::vector<Eigen::Vector3d> all = street_.points;
    street_.points.clear();
    for (const Eigen::Vector3d& p : all) {
      for (int turn = 0; p.x() >= 0.0 && p.x() < kPeriod && turn < 7; ++turn) {
        street_.points.emplace_back(p.x() + kPeriod * (turn - 1), p.y(), p.z());
      }
    }
  }

  /// The sensor is at `truth`; the whole map says by log-odds how well `here` and the stretch behind fit.
  RelocalizedScan drive_to(double truth, double here, double log_odds_here, double log_odds_behind,
                           bool parked = false) {
    map_->answers = {{at(here), Matrix6d::Identity(), log_odds_here},
                     {at(here + kPeriod), Matrix6d::Identity(), log_odds_behind}};
    std::stable_sort(
        map_->answers.begin(), map_->answers.end(),
        [](const LocalizationHypothesis& a, const LocalizationHypothesis& b) { return a.log_odds > b.log_odds; });
    Scan scan = street_.seen_from(at(truth), next_++);
    for (double x = -40.0; parked && x < 40.0; x += 0.4) {  // lorries that are not in the map, along both sides
      for (double z = -0.6; z < 3.0; z += 0.4) {
        for (const double y : {-3.0, -1.5, 1.5, 3.0}) {
          scan.cloud.points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
        }
      }
    }
    return relocalizer_.add(scan);
  }

  static Pose at(double x) { return pose_from_yaw(0.0, {x, 0.0, 0.0}); }

  /// Follows the street from 20 m on, to 24 m.
  void follow() {
    relocalizer_.place(at(20.0));
    for (double x = 20.0; x < 25.0; x += 1.0) {
      ASSERT_EQ(drive_to(x, x, 4.0, -4.0).state, RelocalizationState::kTracking) << x;
    }
  }

  Street street_;
  std::shared_ptr<TellingMap> map_ = std::make_shared<TellingMap>(street_);
  Relocalizer relocalizer_{map_, {}};
  std::size_t next_ = 0;
};

TEST_F(AlikeStretchesTest, AfterAGapAnotherStretchThatFitsClearlyBetterIsTaken) {
  follow();
  next_ += 5;
  const RelocalizedScan answer = drive_to(30.0 + kPeriod, 30.0, 1.1, 6.0);
  EXPECT_TRUE(answer.given_up);
  ASSERT_TRUE(answer.answered) << answer.reason;
  EXPECT_LT(pose_error(answer.T_map_lidar, at(30.0 + kPeriod)).translation_m, 0.15);
  EXPECT_EQ(map_->searches, 1) << "what the map said is not asked twice";
}

TEST_F(AlikeStretchesTest, AScanOfWhichFewerPointsFitThanUsualIsSearchedThoughNothingElseTellsOfAJump) {
  follow();
  const RelocalizedScan answer = drive_to(25.0 + kPeriod, 25.0, 1.1, 6.0, true);
  EXPECT_EQ(map_->searches, 1);
  EXPECT_TRUE(answer.given_up);
  ASSERT_TRUE(answer.answered) << answer.reason;
  EXPECT_LT(pose_error(answer.T_map_lidar, at(25.0 + kPeriod)).translation_m, 0.15);
}

TEST_F(AlikeStretchesTest, FewerPointsThatFitAreUsualFromThenOnWhereThePlaceHolds) {
  follow();
  for (double x = 25.0; x < 29.0; x += 1.0) {
    const RelocalizedScan answer = drive_to(x, x, 4.0, 1.0, true);
    EXPECT_TRUE(answer.answered) << answer.reason;
    EXPECT_FALSE(answer.given_up);
  }
  EXPECT_EQ(map_->searches, 1);
}

TEST_F(AlikeStretchesTest, AfterAGapNoPoseIsGivenWhileAnotherStretchFitsBetter) {
  follow();
  next_ += 5;
  RelocalizedScan answer = drive_to(30.0, 30.0, 3.0, 4.0);
  EXPECT_FALSE(answer.answered);
  EXPECT_EQ(answer.state, RelocalizationState::kTracking);
  EXPECT_FALSE(drive_to(31.0, 31.0, 3.0, 4.0).answered) << "the doubt stays";
  answer = drive_to(32.0, 32.0, 4.0, 4.0);
  EXPECT_TRUE(answer.answered) << answer.reason;
  EXPECT_FALSE(answer.given_up);
  EXPECT_LT(pose_error(answer.T_map_lidar, at(32.0)).translation_m, 0.15);
  EXPECT_LT(answer.p_correct, 0.97) << "a tie, with own motion for the one";
  EXPECT_EQ(map_->searches, 3);
}

TEST_F(AlikeStretchesTest, AWrongStretchThatIsFollowedIsNoticedBySearchingOnTheWay) {
  relocalizer_.place(at(20.0));
  double given_up_at = 0.0;
  for (double x = 20.0; x < 150.0 && given_up_at == 0.0; x += 1.0) {  // it is one stretch further on
    given_up_at = drive_to(x + kPeriod, x, 1.0, 6.0).given_up ? x : 0.0;
  }
  EXPECT_GE(given_up_at, 70.0);
  EXPECT_LT(given_up_at, 100.0);
}

TEST_F(AlikeStretchesTest, NormalDrivingAmongStretchesThatAreAlikeIsNoLoss) {
  relocalizer_.place(at(20.0));
  for (double x = 20.0; x < 200.0; x += 1.0) {
    const bool other_is_better = static_cast<int>(x / 5.0) % 3 == 0;
    const RelocalizedScan answer = drive_to(x, x, 3.0, other_is_better ? 4.0 : 2.0);
    ASSERT_TRUE(answer.answered) << x << ": " << answer.reason;
    EXPECT_LT(pose_error(answer.T_map_lidar, at(x)).translation_m, 0.15);
  }
  EXPECT_GE(map_->searches, 3);
  EXPECT_LE(map_->searches, 10);
}

/// A raw log: what a scan shows where it is searched is told, and what it shows without its motion, too.
class DistortedScansMap final : public PlaceMap {
 public:
  explicit DistortedScansMap(const testing_support::BoxWorld& world) : world_(world) {}

  std::vector<LocalizationHypothesis> search(const PointCloud& /*scan*/, std::size_t places,
                                             const std::vector<Pose>& priors) const override {
    if (places > 0) {
      return answers;
    }
    std::vector<LocalizationHypothesis> again;
    for (std::size_t i = 0; i < priors.size() && i < undistorted.size(); ++i) {
      again.push_back({priors[i], Matrix6d::Identity(), undistorted[i]});
    }
    std::stable_sort(again.begin(), again.end(), [](const LocalizationHypothesis& a, const LocalizationHypothesis& b) {
      return a.log_odds > b.log_odds;
    });
    return again;
  }
  std::vector<LocalizationHypothesis> judge(const PointCloud& /*scan*/,
                                            const std::vector<Pose>& /*believed*/) const override {
    return {};
  }
  std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& position, double radius) const override {
    std::vector<Eigen::Vector3d> points;
    for (double x = 30.0; x <= 90.0; x += 4.0) {
      const Pose pose = pose_from_yaw(0.0, {x, 0.0, 1.8});
      for (const Eigen::Vector3f& p : testing_support::sweep(world_, pose, Vector6d::Zero()).points) {
        const Eigen::Vector3d q = pose * p.cast<double>();
        if ((q - position).norm() < radius) {
          points.push_back(q);
        }
      }
    }
    return points;
  }

  std::vector<LocalizationHypothesis> answers;
  std::vector<double> undistorted;  ///< log-odds of the places believed, in their order

 private:
  const testing_support::BoxWorld& world_;
};

class DistortedScansTest : public ::testing::Test {
 protected:
  RelocalizedScan add(const Pose& truth, double speed_mps, double stamp_s) {
    Scan scan;
    scan.index = next_++;
    scan.stamp_s = stamp_s;
    scan.cloud = testing_support::sweep(world_, truth, speed_mps * Vector6d::Unit(0), 0.01, scan.index);
    return relocalizer_.add(scan);
  }

  static Pose at(double x) { return pose_from_yaw(0.0, {x, 0.3, 1.8}); }
  static RelocalizationOptions every_scan() {
    RelocalizationOptions options;
    options.search_every_m = 0.0;
    return options;
  }

  testing_support::BoxWorld world_ = testing_support::street(120.0, 6);
  std::shared_ptr<DistortedScansMap> map_ = std::make_shared<DistortedScansMap>(world_);
  Relocalizer relocalizer_{map_, every_scan(), {}, odometry::Compensation::kRawGivenTimes};
  std::size_t next_ = 0;
};

TEST_F(DistortedScansTest, TheMotionOfTheFirstScanBehindAGapIsToldByTheMap) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(add(at(56.0), 0.0, 0.1 * i).answered) << "it stands, and knows no place";
  }
  const Pose truth = at(60.0);  // a second later it drives at 12 m/s: its mean motion tells of 4
  map_->answers = {{truth * pose_from_yaw(0.01, {-0.8, 0.1, 0.0}), Matrix6d::Identity(), 1.2}};
  map_->undistorted = {1.3};
  const RelocalizedScan answer = add(truth, 12.0, 1.2);
  ASSERT_TRUE(answer.answered) << answer.reason;
  EXPECT_EQ(answer.state, RelocalizationState::kSearching) << "it is not sure enough to track";
  EXPECT_LT(pose_error(answer.T_map_lidar, truth).translation_m, 0.15);
}

TEST_F(DistortedScansTest, OfTwoPlacesTheUndistortedScanTellsWhichItIsAt) {
  const LocalizationHypothesis here = {at(58.0), Matrix6d::Identity(), 4.0};
  const LocalizationHypothesis there = {at(58.0 + 68.0), Matrix6d::Identity(), 0.0};
  map_->answers = {here, there};
  map_->undistorted = {2.0, 1.5};
  RelocalizedScan answer = add(here.T_map_lidar, 10.0, 0.0);
  EXPECT_FALSE(answer.answered) << "at either, though the distorted scan told them apart";
  EXPECT_NEAR(answer.p_correct, 1.0 / (1.0 + std::exp(-0.5)), 0.02);
}

TEST_F(RelocalizerTest, AnEmptyScanIsNoAnswer) {
  const RelocalizedScan answer = relocalizer_.add(Scan{});
  EXPECT_FALSE(answer.answered);
  EXPECT_FALSE(answer.reason.empty());
}

TEST(RelocalizationOptions, AreChecked) {
  RelocalizationOptions options;
  options.tracking_p = 0.3;
  EXPECT_THROW(check(options), InputError);
  options = {};
  options.places = 0;
  EXPECT_THROW(check(options), InputError);
}

}  // namespace
}  // namespace loopmark::localization

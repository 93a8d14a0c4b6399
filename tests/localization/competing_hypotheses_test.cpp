// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Which of several places that all fit a scan it is at.
#include "../../libs/localization/src/competing_hypotheses.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numeric>

#include "../../libs/localization/src/place_registration.hpp"
#include "../../libs/localization/src/place_submaps.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "support/box_world.hpp"

namespace loopmark::localization {
namespace {

std::vector<LocalizationHypothesis> answers_of(const std::vector<double>& log_odds) {
  std::vector<LocalizationHypothesis> answers;
  for (const double l : log_odds) {
    answers.push_back(
        {pose_from_yaw(0.0, {68.0 * static_cast<double>(answers.size()), 0.0, 0.0}), Matrix6d::Identity(), l});
  }
  return answers;
}

std::vector<double> told_apart(const std::vector<double>& log_odds,
                               const std::vector<std::optional<double>>& verdicts) {
  std::vector<LocalizationHypothesis> answers = answers_of(log_odds);
  internal::separate_competing_hypotheses(answers, verdicts);
  std::vector<double> after;
  for (const LocalizationHypothesis& answer : answers) {
    after.push_back(answer.log_odds);
  }
  return after;
}

double odds_of_all(const std::vector<double>& log_odds) {
  return std::accumulate(log_odds.begin(), log_odds.end(), 0.0, [](double sum, double l) { return sum + std::exp(l); });
}

TEST(Competitors, ShareTheirOddsByTheVerdictsOfSubmapsThatStandAlike) {
  const std::vector<double> before = {9.6, 5.8, -2.0, -4.0};
  const std::vector<double> after = told_apart(before, {6.0, 10.0, -9.0, 20.0});
  EXPECT_NEAR(odds_of_all(after), odds_of_all(before), 1e-9 * odds_of_all(before)) << "it is at one of them as surely";
  EXPECT_NEAR(after[1] - after[0], 4.0, 1e-9) << "whichever submap was surest of either";
  EXPECT_NEAR(after[1] - after[2], 19.0, 1e-9);
  EXPECT_EQ(after[3], -4.0) << "no competitor";
}

TEST(Competitors, StayAsTheyAreWhereOneCannotBeJudgedSo) {
  const std::vector<double> before = {4.0, 3.0};
  EXPECT_EQ(told_apart(before, {std::nullopt, 8.0}), before);
}

TEST(Competitors, OneAloneKeepsItsLogOdds) {
  EXPECT_EQ(told_apart({4.0, -3.5}, {std::nullopt, std::nullopt}), (std::vector<double>{4.0, -3.5}));
  EXPECT_TRUE(told_apart({}, {}).empty());
}

// ---- verdicts ----

/// A mapped street along x, with a keyframe every 4 m.
class VerdictTest : public ::testing::Test {
 protected:
  static constexpr double kLength = 120.0;

  VerdictTest()
      : path_(std::filesystem::temp_directory_path() / ("loopmark_verdict_" + std::to_string(::getpid()))),
        run_((std::filesystem::remove_all(path_.string() + ".partial"), map_store::RunFolder::create(path_))) {
    for (double x = 0.0; x <= kLength; x += 4.0) {
      mapping::Keyframe keyframe;
      keyframe.number = solved_.keyframes.size();
      solved_.keyframes.push_back(keyframe);
      solved_.T_map_keyframe.push_back(at(x));
      solved_.solution.component_of.push_back(0);
      map_store::write_keyframe_cloud(run_, keyframe.number, seen_from(at(x), keyframe.number));
    }
  }
  ~VerdictTest() override { std::filesystem::remove_all(run_.path()); }

  static Pose at(double x, double y = 0.0) { return pose_from_yaw(0.0, {x, y, 1.8}); }

  PointCloud seen_from(const Pose& pose, std::size_t noise) const {
    return testing_support::sweep(world_, pose, Vector6d::Zero(), 0.01, noise);
  }

  testing_support::BoxWorld world_ = testing_support::street(kLength, 6);
  std::filesystem::path path_;
  map_store::RunFolder run_;
  mapping::SolvedMap solved_;
};

TEST_F(VerdictTest, IsTheSumOfWhatTheSubmapsAroundAPoseAndBesideItSay) {
  const internal::PlaceSubmaps submaps(run_, solved_, {}, 12.0, {});
  const RelocalizationOptions options;
  const internal::PlaceRegistration registration(submaps, options, {});
  const Pose truth = at(61.0, 1.5);
  const registration::PreparedScan scan = registration.prepared(seen_from(truth, 1000));
  const auto right = registration.verdict(scan, truth);
  ASSERT_TRUE(right);
  double sum = 0.0;
  for (const internal::SubmapHypothesis& one : registration.at_poses(scan, {truth})) {
    sum += agree(one.answer.T_map_lidar, truth, options) ? one.place_evidence.registration : 0.0;
  }
  EXPECT_NEAR(*right, sum, 1e-9);
  EXPECT_GT(*right, 0.0);
  const auto wrong = registration.verdict(scan, at(31.0, 1.5));
  ASSERT_TRUE(wrong);
  EXPECT_LT(*wrong, *right - kClearLead);
  EXPECT_GE(*wrong, 2.0 * kNotThere) << "where nothing fits";
  EXPECT_FALSE(registration.verdict(scan, at(61.0, 13.5))) << "no submap is around it: one from afar is surer";
}

}  // namespace
}  // namespace loopmark::localization

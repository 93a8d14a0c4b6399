// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/place_beliefs.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopmark::localization {
namespace {

/// An answer that would have probability `p` if it were the only one.
LocalizationHypothesis answer(double x, double p) {
  return {pose_from_yaw(0.1, {x, 2.0, 0.0}), Matrix6d::Identity(), std::log(p / (1.0 - p))};
}

Pose moved(double x) { return pose_from_yaw(0.0, {x, 0.0, 0.0}); }

TEST(PlaceBeliefs, OneAnswerKeepsItsProbability) {
  PlaceBeliefs beliefs({});
  EXPECT_FALSE(beliefs.best());
  beliefs.add({answer(10.0, 0.8)}, moved(0.0));
  ASSERT_TRUE(beliefs.best());
  EXPECT_NEAR(beliefs.best()->p, 0.8, 1e-9);
  EXPECT_LT(pose_error(beliefs.best()->T_map_odometry, answer(10.0, 0.8).T_map_lidar).translation_m, 1e-9);
}

TEST(PlaceBeliefs, TwoPlacesThatAreAlikeShareWhatOneWouldGet) {
  PlaceBeliefs beliefs({});
  beliefs.add({answer(10.0, 0.9), answer(300.0, 0.9)}, moved(0.0));
  // Odds 9 : 9 : 1.
  EXPECT_NEAR(beliefs.best()->p, 9.0 / 19.0, 1e-9);
  EXPECT_LT(beliefs.best()->p, RelocalizationOptions().min_p_correct);
}

TEST(PlaceBeliefs, ALeaderThatHardlyLeadsIsNotDecided) {
  PlaceBeliefs beliefs({});
  EXPECT_FALSE(beliefs.decided());
  beliefs.add({answer(10.0, 0.99), answer(300.0, 0.97)}, moved(0.0));
  // Odds 99 : 32 : 1.
  EXPECT_GT(beliefs.best()->p, RelocalizationOptions().min_p_correct);
  EXPECT_FALSE(beliefs.decided());
  PlaceBeliefs clear({});
  clear.add({answer(10.0, 0.99), answer(300.0, 0.45)}, moved(0.0));
  EXPECT_TRUE(clear.decided()) << "99 : 0.8 : 1";
}

TEST(PlaceBeliefs, APlaceThatTheLatestScanFitsNearlyAsWellIsARival) {
  const auto fits = [](double x, const Pose& here, double log_odds) {
    return LocalizationHypothesis{answer(x, 0.5).T_map_lidar * here, Matrix6d::Identity(), log_odds};
  };
  PlaceBeliefs beliefs({});
  beliefs.add({fits(10.0, moved(0.0), 6.0), fits(300.0, moved(0.0), 3.5)}, moved(0.0));
  EXPECT_GT(beliefs.best()->p, 0.9);
  EXPECT_FALSE(beliefs.decided()) << "both places fit";
  beliefs.add({fits(10.0, moved(5.0), 3.0), fits(300.0, moved(5.0), 0.5)}, moved(5.0));
  EXPECT_GT(beliefs.best()->log_odds - beliefs.all()[1].log_odds, 3.0);
  EXPECT_FALSE(beliefs.decided()) << "the latest scan alone does not tell them apart";
  beliefs.add({fits(10.0, moved(7.0), 3.0), fits(300.0, moved(7.0), -3.0)}, moved(7.0));
  EXPECT_TRUE(beliefs.decided()) << "the other one does not fit any more";
  beliefs.add({fits(10.0, moved(9.0), -0.5)}, moved(9.0));
  EXPECT_FALSE(beliefs.decided()) << "now it does not fit itself";

  PlaceBeliefs clear({});
  clear.add({fits(10.0, moved(0.0), 7.0), fits(300.0, moved(0.0), 3.5)}, moved(0.0));
  EXPECT_TRUE(clear.decided()) << "the other one is far behind";
  PlaceBeliefs changed({});
  changed.add({fits(10.0, moved(0.0), 2.0), fits(300.0, moved(0.0), 4.0)}, moved(0.0));
  changed.add({fits(10.0, moved(5.0), 5.5), fits(300.0, moved(5.0), 1.5)}, moved(5.0));
  EXPECT_FALSE(changed.decided()) << "the latest scan tells them apart, but all together do not";

  PlaceBeliefs weak({});
  weak.add({fits(10.0, moved(0.0), 1.5), fits(300.0, moved(0.0), -0.5)}, moved(0.0));
  EXPECT_GT(weak.best()->p, RelocalizationOptions().min_p_correct);
  EXPECT_FALSE(weak.decided()) << "neither fits well, and the other one hardly less";

  PlaceBeliefs beside({});
  beside.add({fits(10.0, moved(0.0), 6.0), fits(12.0, moved(0.0), 4.0)}, moved(0.0));
  EXPECT_TRUE(beside.decided()) << "2 m apart they are one place: min_lead decides";
}

TEST(PlaceBeliefs, TwoAlikePlacesStayUndecidedHoweverOftenBothAreSeen) {
  PlaceBeliefs beliefs({});
  for (int i = 0; i < 40; ++i) {
    const Pose here = moved(2.0 * i);
    beliefs.add({LocalizationHypothesis{answer(10.0, 0.5).T_map_lidar * here, Matrix6d::Identity(), 4.0},
                 LocalizationHypothesis{answer(300.0, 0.5).T_map_lidar * here, Matrix6d::Identity(), 3.999}},
                here);
  }
  EXPECT_FALSE(beliefs.decided());
  EXPECT_NEAR(beliefs.all()[1].p, beliefs.all()[0].p, 0.02);
}

TEST(PlaceBeliefs, AnswersToOneScanThatSayTheSameCountOnce) {
  PlaceBeliefs beliefs({});
  beliefs.add({answer(10.0, 0.7), answer(10.3, 0.8), answer(9.8, 0.6)}, moved(0.0));
  EXPECT_EQ(beliefs.all().size(), 1U);
  EXPECT_NEAR(beliefs.best()->p, 0.8, 1e-9);
}

TEST(PlaceBeliefs, MoreScansDecideBetweenPlacesThatAreAlike) {
  PlaceBeliefs beliefs({});
  beliefs.add({answer(10.0, 0.9), answer(300.0, 0.9)}, moved(0.0));
  beliefs.add({LocalizationHypothesis{answer(10.0, 0.5).T_map_lidar * moved(5.0), Matrix6d::Identity(), std::log(9.0)}},
              moved(5.0));
  // Odds 9 * sqrt(9) and 9 * 0.4 against 1.
  EXPECT_NEAR(beliefs.best()->p, 27.0 / 31.6, 1e-6);
  EXPECT_NEAR(beliefs.best()->T_map_odometry.translation().x(), 10.0, 1e-9);
}

TEST(PlaceBeliefs, WhatIsNeverConfirmedFades) {
  PlaceBeliefs beliefs({});
  beliefs.add({answer(10.0, 0.8)}, moved(0.0));
  beliefs.add({}, moved(2.0));
  EXPECT_LT(beliefs.best()->p, 0.8);
  for (int i = 0; i < 8; ++i) {
    beliefs.add({}, moved(4.0 + 2.0 * i));
  }
  EXPECT_FALSE(beliefs.best());
}

TEST(PlaceBeliefs, ProbabilitiesAndNoneOfTheseMakeOne) {
  PlaceBeliefs beliefs({});
  beliefs.add({answer(10.0, 0.9), answer(100.0, 0.5), answer(200.0, 0.2)}, moved(0.0));
  double sum = 0.0;
  for (const PlaceBelief& belief : beliefs.all()) {
    sum += belief.p;
  }
  // Odds 9, 1, 0.25 against 1.
  EXPECT_NEAR(1.0 - sum, 1.0 / 11.25, 1e-9);
}

TEST(PlaceAnswers, SayTheSameOrAreOfDifferentPlacesOrNeither) {
  const RelocalizationOptions options;
  const Pose here = pose_from_yaw(0.3, {10.0, 20.0, 1.0});
  const auto beside = [&](double metres, double degrees) {
    return Pose(here * pose_from_yaw(degrees * 3.14159265 / 180.0, {0.0, metres, 0.0}));
  };
  EXPECT_TRUE(agree(here, beside(0.9 * options.same_place_m, 0.9 * options.same_place_deg), options));
  EXPECT_FALSE(agree(here, beside(1.1 * options.same_place_m, 0.0), options));
  EXPECT_FALSE(agree(here, beside(0.0, 1.1 * options.same_place_deg), options));
  EXPECT_FALSE(are_different_places(here, beside(4.9, 19.0)));
  EXPECT_TRUE(are_different_places(here, beside(5.1, 0.0)));
  EXPECT_TRUE(are_different_places(here, beside(0.0, -21.0)));
}

}  // namespace
}  // namespace loopmark::localization

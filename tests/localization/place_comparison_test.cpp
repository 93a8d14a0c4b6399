// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/localization/src/place_comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "loopmark/core/random.hpp"

namespace loopmark::localization {
namespace {

using Verdict = internal::PlaceComparison::Verdict;

LocalizationHypothesis answer(double x, double log_odds) {
  return {pose_from_yaw(0.1, {x, 2.0, 0.0}), Matrix6d::Identity(), log_odds};
}

internal::PlaceComparison said_at_ten(const std::vector<LocalizationHypothesis>& answers) {
  return internal::compare_places(answers, answer(10.0, 0.0).T_map_lidar, {});
}

TEST(PlaceComparison, ATieIsInFavourOfThePlaceThatOwnMotionLeadsTo) {
  const internal::PlaceComparison said = said_at_ten({answer(78.0, 4.0), answer(10.3, 4.0)});
  EXPECT_EQ(said.verdict, Verdict::kHolds);
  EXPECT_NEAR(said.here.T_map_lidar.translation().x(), 10.3, 1e-9);
  EXPECT_DOUBLE_EQ(said.lead, 0.0);
  EXPECT_NEAR(said.log_odds, 3.0 + 4.0 - std::log(1.0 + std::exp(4.0)), 1e-9);
}

TEST(PlaceComparison, AnotherPlaceMustLeadClearlyToBeTaken) {
  EXPECT_EQ(said_at_ten({answer(78.0, 4.0), answer(10.0, 2.0)}).verdict, Verdict::kOpen);
  EXPECT_EQ(said_at_ten({answer(78.0, 4.0), answer(10.0, 1.0)}).verdict, Verdict::kElsewhere);
  EXPECT_EQ(said_at_ten({answer(78.0, 1.0)}).verdict, Verdict::kElsewhere) << "of this place it says nothing";
}

TEST(PlaceComparison, AScanThatFitsNowhereTellsNothing) {
  EXPECT_EQ(said_at_ten({}).verdict, Verdict::kOpen);
  EXPECT_EQ(said_at_ten({answer(10.0, -0.5)}).verdict, Verdict::kOpen);
  EXPECT_EQ(said_at_ten({answer(78.0, -0.5)}).verdict, Verdict::kOpen);
  EXPECT_LT(said_at_ten({}).lead, 0.0);
}

TEST(PlaceComparison, TwoAnswersAboutThePlaceMustBeToldApartToo) {
  EXPECT_EQ(said_at_ten({answer(10.0, 3.0), answer(12.2, 2.0)}).verdict, Verdict::kOpen);
  EXPECT_EQ(said_at_ten({answer(10.0, 3.0), answer(10.9, 2.9)}).verdict, Verdict::kHolds) << "they say the same";
  const internal::PlaceComparison said = said_at_ten({answer(10.0, -3.0), answer(12.2, 5.0)});
  EXPECT_EQ(said.verdict, Verdict::kHolds) << "tracking had slid along the street";
  EXPECT_NEAR(said.here.T_map_lidar.translation().x(), 12.2, 1e-9);
}

TEST(PlaceComparison, TheOrderOfTheAnswersDoesNotMatterAndMoreForThePlaceNeverTellsAgainstIt) {
  Rng rng(7);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<LocalizationHypothesis> answers;
    for (std::uint32_t i = 0; i < 1 + rng.below(5); ++i) {
      answers.push_back(answer(rng.uniform(0.0, 40.0), rng.uniform(-5.0, 6.0)));
    }
    const internal::PlaceComparison said = said_at_ten(answers);
    std::reverse(answers.begin(), answers.end());
    const internal::PlaceComparison again = said_at_ten(answers);
    EXPECT_EQ(said.verdict, again.verdict);
    EXPECT_DOUBLE_EQ(said.lead, again.lead);
    EXPECT_NEAR(said.log_odds, again.log_odds, 1e-9);
    answers.push_back(answer(10.0, 8.0));
    const internal::PlaceComparison more = said_at_ten(answers);
    EXPECT_EQ(more.verdict, Verdict::kHolds);
    EXPECT_GT(more.lead, said.lead);
    EXPECT_GT(more.log_odds, said.log_odds);
  }
}

}  // namespace
}  // namespace loopmark::localization

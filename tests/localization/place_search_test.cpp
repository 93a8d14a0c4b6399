// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The parts of the search in a run's map that need no run.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "../../libs/localization/src/lru_cache.hpp"
#include "../../libs/localization/src/place_centers.hpp"
#include "../../libs/localization/src/place_confidence.hpp"
#include "../../libs/localization/src/place_hypothesis.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/mapping/map_truth.hpp"

namespace loopmark::localization {
namespace {

Pose at(double x, double y, double yaw = 0.0) { return pose_from_yaw(yaw, {x, y, 0.0}); }

TEST(PlaceCenters, EveryKeyframeIsNearItsCenterAsBruteForceFindsIt) {
  constexpr double kNear = 6.0;
  Rng rng(3);
  std::vector<Pose> poses;
  for (int i = 0; i < 400; ++i) {
    poses.push_back(at(rng.uniform(-60.0, 60.0), rng.uniform(-20.0, 20.0)));
  }
  const std::vector<std::size_t> centers = internal::place_centers(poses, kNear);
  ASSERT_EQ(centers.size(), poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    std::size_t expected = k;
    double least = kNear;
    for (std::size_t c = 0; c < k; ++c) {
      const double away = (poses[c].translation() - poses[k].translation()).norm();
      if (centers[c] == c && away < least) {
        expected = c;
        least = away;
      }
    }
    EXPECT_EQ(centers[k], expected) << k;
  }
}

internal::SubmapHypothesis found(double x, double registration, std::size_t center) {
  internal::SubmapHypothesis one;
  one.answer.T_map_lidar = at(x, 0.0);
  one.place_evidence.registration = registration;
  one.center = center;
  one.centers = {center};
  return one;
}

TEST(FoundPlaces, ThatSayTheSameAreOneWithTheVoicesOfAll) {
  const auto distinct = internal::distinct_hypotheses(
      {found(10.0, 1.0, 4), found(90.0, 2.0, 7), found(10.4, 3.0, 5), found(10.2, -2.0, 4)}, {});
  ASSERT_EQ(distinct.size(), 2U);
  EXPECT_DOUBLE_EQ(distinct[0].answer.T_map_lidar.translation().x(), 10.4);
  EXPECT_DOUBLE_EQ(distinct[0].place_evidence.registration, 3.0);
  EXPECT_DOUBLE_EQ(distinct[0].place_evidence.support, 2.0) << "two submaps, one of them with two modes";
  EXPECT_DOUBLE_EQ(distinct[1].place_evidence.support, 1.0);
}

TEST(LogOddsOfModes, UndoTheEnginesProbabilities) {
  registration::RegistrationResult result;
  const std::vector<double> log_odds = {2.5, 0.3, -3.0};
  double sum = 1.0;
  for (const double l : log_odds) {
    sum += std::exp(l);
  }
  for (const double l : log_odds) {
    registration::RegistrationMode mode;
    mode.p_correct = std::exp(l) / sum;
    result.modes.push_back(mode);
  }
  const std::vector<double> back = internal::log_odds_of_modes(result);
  ASSERT_EQ(back.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(back[i], log_odds[i], 1e-9);
  }
  EXPECT_TRUE(internal::log_odds_of_modes({}).empty());
}

TEST(PlaceLogOdds, OfTheSurestAnswerAreTheEngines) {
  EXPECT_DOUBLE_EQ(internal::place_log_odds({2.5, 3.0, 0.0}), 2.5);
  const registration::Evidence known = {{"agreement", 0.3}};
  EXPECT_DOUBLE_EQ(internal::place_log_odds({2.5, 1.0, 0.0, internal::compared(known, known)}), 2.5);
}

TEST(PlaceLogOdds, FallWhereTheBestAnswerFitsBetter) {
  const registration::Evidence best = {
      {"agreement", 0.3}, {"low_missing", -4.0}, {"tall_strong_violation", -5.0}, {"ground_gap", 0.02}};
  const registration::Evidence worse = {
      {"tall_strong_violation", -3.0}, {"agreement", 0.2}, {"low_missing", -2.5}, {"far_violation", -1.0}};
  const internal::Comparison beyond = internal::compared(worse, best);
  EXPECT_NEAR(beyond[0], -0.1, 1e-12) << "agreement";
  EXPECT_NEAR(beyond[1], 1.5, 1e-12) << "low_missing";
  EXPECT_NEAR(beyond[2], 2.0, 1e-12) << "tall_strong_violation";
  EXPECT_EQ(beyond[3], 0.0) << "far_violation is not known of one of them";
  EXPECT_EQ(beyond[4], 0.0) << "nor the gap of the ground";
  EXPECT_LT(internal::place_log_odds({3.0, 1.0, 0.0, beyond}),
            internal::place_log_odds({3.0, 1.0, 0.0, internal::compared(best, best)}));
}

TEST(PlaceLogOdds, GrowWithWhatTheEngineSays) {
  EXPECT_GT(internal::place_log_odds({3.0, 1.0, 0.0}), internal::place_log_odds({1.0, 1.0, 0.0}));
  EXPECT_GE(internal::place_log_odds({3.0, 3.0, 0.0}), internal::place_log_odds({3.0, 1.0, 0.0}));
  EXPECT_LE(internal::place_log_odds({3.0, 1.0, 0.3}), internal::place_log_odds({3.0, 1.0, 0.0}));
}

TEST(LruCache, KeepsWhatWasUsedLastAndMakesNothingTwice) {
  internal::LruCache<int> cache(2);
  int made = 0;
  const auto get = [&](std::size_t key) {
    return cache.get(key, [&] {
      ++made;
      return static_cast<int>(10 * key);
    });
  };
  EXPECT_EQ(get(1), 10);
  EXPECT_EQ(get(2), 20);
  EXPECT_EQ(get(1), 10);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(get(3), 30);
  EXPECT_EQ(get(1), 10) << "2 was dropped, not 1";
  EXPECT_EQ(made, 3);
  get(2);
  EXPECT_EQ(made, 4);
}

TEST(MapTruth, ComparesThroughTheNearestScanOfTheMap) {
  // The map drifts by 10 m between its two scans; the world is turned and shifted.
  const Pose T_world_map = pose_from_yaw(1.0, {100, 50, 0});
  const mapping::MapTruth truth({at(0, 0), at(15, 0)}, {T_world_map, T_world_map * at(5, 0)});
  const Pose near_second = T_world_map * at(4.5, 1.0, 0.2);
  EXPECT_LT(pose_error(truth.in_map(near_second), at(14.5, 1.0, 0.2)).translation_m, 1e-9);
  EXPECT_NEAR(truth.error(at(14.5, 1.3, 0.2), near_second).translation_m, 0.3, 1e-9);
  EXPECT_NEAR(truth.distance(T_world_map * at(5.0, 3.0)), 3.0, 1e-9);
  EXPECT_THROW(mapping::MapTruth({}, {}), std::invalid_argument);
  EXPECT_THROW(mapping::MapTruth({at(0, 0)}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::localization

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The parts of the search in a run's map that need no run.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "../../libs/slam/src/found_place.hpp"
#include "../../libs/slam/src/lru_cache.hpp"
#include "../../libs/slam/src/place_centers.hpp"
#include "../../libs/slam/src/place_confidence.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/slam/map_truth.hpp"

namespace loopmark {
namespace {

Pose at(double x, double y, double yaw = 0.0) { return pose_from_yaw(yaw, {x, y, 0.0}); }

TEST(PlaceCenters, EveryKeyframeIsNearItsCenterAsBruteForceFindsIt) {
  constexpr double kNear = 6.0;
  Rng rng(3);
  std::vector<Pose> poses;
  for (int i = 0; i < 400; ++i) {
    poses.push_back(at(rng.uniform(-60.0, 60.0), rng.uniform(-20.0, 20.0)));
  }
  const std::vector<std::size_t> centers = place_centers(poses, kNear);
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

FoundPlace found(double x, double registration, std::size_t center) {
  FoundPlace one;
  one.answer.T_map_lidar = at(x, 0.0);
  one.voices.registration = registration;
  one.center = center;
  one.centers = {center};
  return one;
}

TEST(FoundPlaces, ThatSayTheSameAreOneWithTheVoicesOfAll) {
  const auto distinct =
      distinct_places_found({found(10.0, 1.0, 4), found(90.0, 2.0, 7), found(10.4, 3.0, 5), found(10.2, -2.0, 4)}, {});
  ASSERT_EQ(distinct.size(), 2U);
  EXPECT_DOUBLE_EQ(distinct[0].answer.T_map_lidar.translation().x(), 10.4);
  EXPECT_DOUBLE_EQ(distinct[0].voices.registration, 3.0);
  EXPECT_DOUBLE_EQ(distinct[0].voices.support, 2.0) << "two submaps, one of them with two modes";
  EXPECT_DOUBLE_EQ(distinct[1].voices.support, 1.0);
}

TEST(LogOddsOfModes, UndoTheEnginesProbabilities) {
  RegistrationResult result;
  const std::vector<double> log_odds = {2.5, 0.3, -3.0};
  double sum = 1.0;
  for (const double l : log_odds) {
    sum += std::exp(l);
  }
  for (const double l : log_odds) {
    RegistrationMode mode;
    mode.p_correct = std::exp(l) / sum;
    result.modes.push_back(mode);
  }
  const std::vector<double> back = log_odds_of_modes(result);
  ASSERT_EQ(back.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(back[i], log_odds[i], 1e-9);
  }
  EXPECT_TRUE(log_odds_of_modes({}).empty());
}

TEST(PlaceLogOdds, OfTheSurestAnswerAreTheEngines) {
  EXPECT_DOUBLE_EQ(place_log_odds({2.5, 3.0, 0.0}), 2.5);
  const Evidence known = {{"agreement", 0.3}};
  EXPECT_DOUBLE_EQ(place_log_odds({2.5, 1.0, 0.0, compared(known, known)}), 2.5);
}

TEST(PlaceLogOdds, FallWhereTheBestAnswerFitsBetter) {
  const Evidence best = {{"agreement", 0.3}, {"low_absence", -4.0}, {"tall_clash", -5.0}, {"ground_gap", 0.02}};
  const Evidence worse = {{"tall_clash", -3.0}, {"agreement", 0.2}, {"low_absence", -2.5}, {"far_conflict", -1.0}};
  const Comparison beyond = compared(worse, best);
  EXPECT_NEAR(beyond[0], -0.1, 1e-12) << "agreement";
  EXPECT_NEAR(beyond[1], 1.5, 1e-12) << "low_absence";
  EXPECT_NEAR(beyond[2], 2.0, 1e-12) << "tall_clash";
  EXPECT_EQ(beyond[3], 0.0) << "far_conflict is not known of one of them";
  EXPECT_EQ(beyond[4], 0.0) << "nor the gap of the ground";
  EXPECT_LT(place_log_odds({3.0, 1.0, 0.0, beyond}), place_log_odds({3.0, 1.0, 0.0, compared(best, best)}));
}

TEST(PlaceLogOdds, GrowWithWhatTheEngineSays) {
  EXPECT_GT(place_log_odds({3.0, 1.0, 0.0}), place_log_odds({1.0, 1.0, 0.0}));
  EXPECT_GE(place_log_odds({3.0, 3.0, 0.0}), place_log_odds({3.0, 1.0, 0.0}));
  EXPECT_LE(place_log_odds({3.0, 1.0, 0.3}), place_log_odds({3.0, 1.0, 0.0}));
}

TEST(LruCache, KeepsWhatWasUsedLastAndMakesNothingTwice) {
  LruCache<int> cache(2);
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
  const MapTruth truth({at(0, 0), at(15, 0)}, {T_world_map, T_world_map * at(5, 0)});
  const Pose near_second = T_world_map * at(4.5, 1.0, 0.2);
  EXPECT_LT(pose_error(truth.in_map(near_second), at(14.5, 1.0, 0.2)).translation_m, 1e-9);
  EXPECT_NEAR(truth.error(at(14.5, 1.3, 0.2), near_second).translation_m, 0.3, 1e-9);
  EXPECT_NEAR(truth.distance(T_world_map * at(5.0, 3.0)), 3.0, 1e-9);
  EXPECT_THROW(MapTruth({}, {}), std::invalid_argument);
  EXPECT_THROW(MapTruth({at(0, 0)}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark

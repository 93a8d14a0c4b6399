// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What several scans together say about where the sensor is.
#pragma once

#include <optional>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/localization/relocalization_options.hpp"
#include "loopmark/registration/engine.hpp"

namespace loopmark::localization {

constexpr double kMostLogOdds = 9.0;  ///< of a place: however many scans agree, 1 in 8000 stays for "none of these"
constexpr double kClearLead = 3.0;    ///< in log-odds: by so much a place must lead every other one
constexpr double kNotThere = -5.0;    ///< log-odds that stand for a place of which a scan says nothing

/// One answer of the registration of a scan to the map.
struct LocalizationHypothesis {
  Pose T_map_lidar = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in exp(xi) * T_map_lidar
  double log_odds = 0.0;                       ///< of this answer against "none of these"
  registration::Evidence evidence = {};        ///< the numbers behind the log-odds
};

/// P(correct) of each answer to one scan: exp(l_i) / (1 + sum_j exp(l_j)), all answers and "none of these" together.
std::vector<double> probabilities(const std::vector<LocalizationHypothesis>& answers);

/// Whether two answers to one scan say the same (options: same_place_m, same_place_deg).
bool agree(const Pose& a, const Pose& b, const RelocalizationOptions& options);

/// Whether two answers are of different places: 5 m or 20 degrees apart. In between they are two answers about one
/// place.
bool are_different_places(const Pose& a, const Pose& b);

/// A place the sensor may be at.
struct PlaceBelief {
  Pose T_map_odometry = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of the latest answer
  double log_odds = 0.0;                       ///< against "none of these"
  double latest = 0.0;                         ///< what the latest scan alone said: log-odds against "none of these"
  double p = 0.0;                              ///< among all beliefs and "none of these"
};

/// Keeps the possible places of a sensor whose own motion is known, and one probability over all of them together: they
/// exclude each other, and "none of these" is one of them. Answers to one scan that say the same count once. While two
/// places are alike neither is given (`decided`), however improbable "none of these" is.
class PlaceBeliefs {
 public:
  explicit PlaceBeliefs(const RelocalizationOptions& options) : options_(options) {}

  /// Takes in all answers found for one scan that stands at T_odometry_lidar; none is an answer too.
  void add(const std::vector<LocalizationHypothesis>& answers, const Pose& T_odometry_lidar);

  /// The most probable place, or nothing.
  std::optional<PlaceBelief> best() const;

  /// Whether the latest scan fits the most probable place, which is min_lead times as probable as the next one and
  /// leads every other place (5 m or 20 degrees away) by log-odds of 3, in what the latest scan says and in what all
  /// say.
  bool decided() const;

  const std::vector<PlaceBelief>& all() const { return beliefs_; }
  void clear() { beliefs_.clear(); }

 private:
  void normalise();

  RelocalizationOptions options_;
  std::vector<PlaceBelief> beliefs_;  ///< most probable first
  Pose latest_ = Pose::Identity();    ///< T_odometry_lidar of the latest scan
};

}  // namespace loopmark::localization

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What several scans together say about where the sensor is.
#pragma once

#include <optional>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/slam/relocalization_options.hpp"

namespace loopmark {

/// One answer of the registration of a scan to a place of the map.
struct PlaceAnswer {
  Pose T_map_lidar = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in exp(xi) * T_map_lidar
  double p_correct = 0.0;                      ///< of this answer alone: right or wrong
};

/// A place the sensor may be at.
struct PlaceBelief {
  Pose T_map_odometry = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of the latest answer
  double log_odds = 0.0;                       ///< against "none of these"
  double p = 0.0;                              ///< among all beliefs and "none of these"
};

/// Keeps the possible places of a sensor whose own motion is known, and one probability over all of them together: they
/// exclude each other, and "none of these" is one of them. Answers to one scan that say the same count once.
class PlaceBeliefs {
 public:
  explicit PlaceBeliefs(const RelocalizationOptions& options) : options_(options) {}

  /// Takes in all answers found for one scan that stands at T_odometry_lidar; none is an answer too.
  void add(const std::vector<PlaceAnswer>& answers, const Pose& T_odometry_lidar);

  /// The most probable place, or nothing.
  std::optional<PlaceBelief> best() const;

  const std::vector<PlaceBelief>& all() const { return beliefs_; }
  void clear() { beliefs_.clear(); }

 private:
  bool same(const Pose& a, const Pose& b) const;
  void normalise();

  RelocalizationOptions options_;
  std::vector<PlaceBelief> beliefs_;  ///< most probable first
};

}  // namespace loopmark

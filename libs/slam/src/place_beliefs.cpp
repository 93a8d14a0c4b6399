// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/place_beliefs.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
namespace {

constexpr double kMaxLogOdds = 9.0;  ///< however many scans agree, 1 in 8000 stays
constexpr double kForgotten = -4.0;  ///< log-odds below which a place is dropped

double log_odds(double p) {
  const double safe = std::clamp(p, 1e-4, 1.0 - 1e-4);
  return std::log(safe / (1.0 - safe));
}

}  // namespace

bool PlaceBeliefs::same(const Pose& a, const Pose& b) const {
  const PoseError error = pose_error(a, b);
  return error.translation_m < options_.same_place_m && error.rotation_deg < options_.same_place_deg;
}

void PlaceBeliefs::add(const std::vector<PlaceAnswer>& answers, const Pose& T_odometry_lidar) {
  std::vector<PlaceAnswer> ranked = answers;
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const PlaceAnswer& a, const PlaceAnswer& b) { return a.p_correct > b.p_correct; });
  const std::size_t known = beliefs_.size();
  std::vector<bool> confirmed(known, false);
  for (const PlaceAnswer& answer : ranked) {
    const auto says_the_same = [&](const PlaceBelief& belief) {
      return same(belief.T_map_odometry * T_odometry_lidar, answer.T_map_lidar);
    };
    const auto found = std::find_if(beliefs_.begin(), beliefs_.end(), says_the_same);
    if (found == beliefs_.end()) {
      beliefs_.push_back(
          {answer.T_map_lidar * T_odometry_lidar.inverse(), answer.covariance, log_odds(answer.p_correct), 0.0});
      continue;
    }
    const auto place = static_cast<std::size_t>(found - beliefs_.begin());
    if (place < known && !confirmed[place]) {
      confirmed[place] = true;
      found->T_map_odometry = answer.T_map_lidar * T_odometry_lidar.inverse();
      found->covariance = answer.covariance;
      found->log_odds += options_.repeat_weight * log_odds(answer.p_correct);
    }
  }
  for (std::size_t place = 0; place < known; ++place) {
    beliefs_[place].log_odds += confirmed[place] ? 0.0 : std::log(options_.miss_odds);
  }
  normalise();
}

void PlaceBeliefs::normalise() {
  std::erase_if(beliefs_, [](const PlaceBelief& b) { return b.log_odds < kForgotten; });
  double sum = 1.0;
  for (PlaceBelief& belief : beliefs_) {
    belief.log_odds = std::min(belief.log_odds, kMaxLogOdds);
    sum += std::exp(belief.log_odds);
  }
  for (PlaceBelief& belief : beliefs_) {
    belief.p = std::exp(belief.log_odds) / sum;
  }
  std::stable_sort(beliefs_.begin(), beliefs_.end(),
                   [](const PlaceBelief& a, const PlaceBelief& b) { return a.p > b.p; });
}

std::optional<PlaceBelief> PlaceBeliefs::best() const {
  return beliefs_.empty() ? std::nullopt : std::optional(beliefs_.front());
}

}  // namespace loopmark

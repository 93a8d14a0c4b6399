// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/place_beliefs.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::localization {
namespace {

constexpr double kElsewhereM = 5.0;  ///< places so far apart are not two answers about one
constexpr double kElsewhereDeg = 20.0;
constexpr double kForgotten = -4.0;  ///< log-odds below which a place is dropped

}  // namespace

std::vector<double> probabilities(const std::vector<LocalizationHypothesis>& answers) {
  double highest = 0.0;  // of "none of these"
  for (const LocalizationHypothesis& answer : answers) {
    highest = std::max(highest, answer.log_odds);
  }
  double total = std::exp(-highest);
  for (const LocalizationHypothesis& answer : answers) {
    total += std::exp(answer.log_odds - highest);
  }
  std::vector<double> p;
  for (const LocalizationHypothesis& answer : answers) {
    p.push_back(std::exp(answer.log_odds - highest) / total);
  }
  return p;
}

bool agree(const Pose& a, const Pose& b, const RelocalizationOptions& options) {
  const PoseError error = pose_error(a, b);
  return error.translation_m < options.same_place_m && error.rotation_deg < options.same_place_deg;
}

bool are_different_places(const Pose& a, const Pose& b) {
  const PoseError apart = pose_error(a, b);
  return apart.translation_m > kElsewhereM || apart.rotation_deg > kElsewhereDeg;
}

void PlaceBeliefs::add(const std::vector<LocalizationHypothesis>& answers, const Pose& T_odometry_lidar) {
  latest_ = T_odometry_lidar;
  std::vector<LocalizationHypothesis> ranked = answers;
  std::stable_sort(ranked.begin(), ranked.end(), [](const LocalizationHypothesis& a, const LocalizationHypothesis& b) {
    return a.log_odds > b.log_odds;
  });
  const std::size_t known = beliefs_.size();
  std::vector<bool> confirmed(known, false);
  for (const LocalizationHypothesis& answer : ranked) {
    const auto says_the_same = [&](const PlaceBelief& belief) {
      return agree(belief.T_map_odometry * T_odometry_lidar, answer.T_map_lidar, options_);
    };
    const auto found = std::find_if(beliefs_.begin(), beliefs_.end(), says_the_same);
    if (found == beliefs_.end()) {
      beliefs_.push_back(
          {answer.T_map_lidar * T_odometry_lidar.inverse(), answer.covariance, answer.log_odds, answer.log_odds, 0.0});
      continue;
    }
    const auto place = static_cast<std::size_t>(found - beliefs_.begin());
    if (place < known && !confirmed[place]) {
      confirmed[place] = true;
      if (answer.log_odds >= 0.0) {
        found->T_map_odometry = answer.T_map_lidar * T_odometry_lidar.inverse();
        found->covariance = answer.covariance;
      }
      found->latest = answer.log_odds;
      found->log_odds += options_.repeat_weight * answer.log_odds;
    }
  }
  for (std::size_t place = 0; place < known; ++place) {
    if (!confirmed[place]) {
      beliefs_[place].log_odds += std::log(options_.miss_odds);
      beliefs_[place].latest = kNotThere;
    }
  }
  normalise();
}

void PlaceBeliefs::normalise() {
  std::erase_if(beliefs_, [](const PlaceBelief& b) { return b.log_odds < kForgotten; });
  double most = 0.0;
  for (const PlaceBelief& belief : beliefs_) {
    most = std::max(most, belief.log_odds);
  }
  double sum = 1.0;
  for (PlaceBelief& belief : beliefs_) {
    belief.log_odds -= std::max(0.0, most - kMostLogOdds);  // their ratios stay
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

bool PlaceBeliefs::decided() const {
  if (beliefs_.empty() || beliefs_.front().latest < 0.0) {
    return false;
  }
  const PlaceBelief& best = beliefs_.front();
  return std::none_of(beliefs_.begin() + 1, beliefs_.end(), [&](const PlaceBelief& other) {
    const bool elsewhere = are_different_places(other.T_map_odometry * latest_, best.T_map_odometry * latest_);
    const double lead = std::min(best.log_odds - other.log_odds, best.latest - other.latest);
    return best.p < options_.min_lead * other.p || (elsewhere && lead < kClearLead);
  });
}

}  // namespace loopmark::localization

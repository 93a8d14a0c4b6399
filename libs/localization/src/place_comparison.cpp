// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_comparison.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::localization::internal {
namespace {

constexpr double kOwnMotion = 3.0;  ///< log-odds that own motion adds to the place it leads to: as much as a clear lead

/// Whether two answers about one place say different things and neither is min_lead times as probable.
bool torn(const LocalizationHypothesis& best, const LocalizationHypothesis& other,
          const RelocalizationOptions& options) {
  return !agree(best.T_map_lidar, other.T_map_lidar, options) &&
         best.log_odds - other.log_odds < std::log(options.min_lead);
}

}  // namespace

PlaceComparison compare_places(const std::vector<LocalizationHypothesis>& answers, const Pose& followed,
                               const RelocalizationOptions& options) {
  PlaceComparison result;
  result.here.log_odds = kNotThere;
  for (const LocalizationHypothesis& answer : answers) {
    if (!are_different_places(answer.T_map_lidar, followed) && answer.log_odds > result.here.log_odds) {
      result.here = answer;
    }
  }
  double best_other = 0.0;  // of "none of these"
  double others = 1.0;      // odds
  bool undecided = false;
  for (const LocalizationHypothesis& answer : answers) {
    if (are_different_places(answer.T_map_lidar, followed)) {
      best_other = std::max(best_other, answer.log_odds);
      others += std::exp(answer.log_odds);
    } else {
      undecided = undecided || torn(result.here, answer, options);
    }
  }
  result.lead = result.here.log_odds - best_other;
  result.log_odds = result.here.log_odds + kOwnMotion - std::log(others);
  if (result.lead >= 0.0) {
    result.verdict = undecided ? PlaceComparison::Verdict::kOpen : PlaceComparison::Verdict::kHolds;
  } else if (best_other > 0.0 && result.lead <= -kClearLead) {
    result.verdict = PlaceComparison::Verdict::kElsewhere;
  }
  return result;
}

}  // namespace loopmark::localization::internal

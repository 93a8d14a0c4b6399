// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/localization/place_beliefs.hpp"

namespace loopmark::localization::internal {

/// What a scan that is searched in the whole map says of the place that is followed there.
struct PlaceComparison {
  enum class Verdict {
    kHolds,     ///< the scan fits there, and nowhere else better
    kOpen,      ///< neither that nor elsewhere is clear
    kElsewhere  ///< another place fits, and leads clearly
  };
  Verdict verdict = Verdict::kOpen;
  LocalizationHypothesis here;  ///< the best answer at the followed place, if there is one: else of log-odds kNotThere
  double lead = 0.0;            ///< log-odds by which the place leads the best other one, and "none of these"
  double log_odds = kNotThere;  ///< of the place among all, with what own motion says for it
};

/// `answers`: of PlaceMap::search; `followed`: T_map_lidar as tracking has it. Answers less than 5 m and 20 degrees
/// from it are about that place. Own motion leads there, so a tie is in its favour; another place must lead as it must
/// to be found by a search.
PlaceComparison compare_places(const std::vector<LocalizationHypothesis>& answers, const Pose& followed,
                               const RelocalizationOptions& options);

}  // namespace loopmark::localization::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "loopmark/localization/place_beliefs.hpp"
#include "place_confidence.hpp"

namespace loopmark::localization::internal {

/// An answer to where a scan is, and how it came about.
struct SubmapHypothesis {
  LocalizationHypothesis answer;
  PlaceEvidence place_evidence;
  std::size_t center = 0;         ///< keyframe at the center of the submap
  bool own_covariance = false;    ///< the covariance is of this mode
  std::set<std::size_t> centers;  ///< of all submaps that say the same
};

/// Each distinct answer once, as the submap that is surest of it says, with the voices of all that say the same; by the
/// engine's log-odds.
std::vector<SubmapHypothesis> distinct_hypotheses(std::vector<SubmapHypothesis> found,
                                                  const RelocalizationOptions& options);

}  // namespace loopmark::localization::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "loopmark/localization/place_beliefs.hpp"

namespace loopmark::localization::internal {

/// Log-odds of one or more together: the logarithm of the sum of their odds.
double log_of_sum(const std::vector<double>& log_odds);

/// The answers, by number, that a scan may be at: of log-odds of -3 or more. Two or more of them are competitors.
std::vector<std::size_t> competing_among(const std::vector<LocalizationHypothesis>& answers);

/// The log-odds of answers tell whether a scan is at one of several places, but hardly at which: each comes from
/// whatever submap is surest of it, and how sure one can be depends on where it stands and what it sees. Which
/// competitor it is, is told by `verdicts`: for each answer, log-odds that submaps at the same distances from each say
/// together, or nothing where there are none (then all stays). The odds of all competitors together stay, and are
/// shared by the verdicts. One competitor alone keeps its log-odds.
void separate_competing_hypotheses(std::vector<LocalizationHypothesis>& answers,
                                   const std::vector<std::optional<double>>& verdicts);

}  // namespace loopmark::localization::internal

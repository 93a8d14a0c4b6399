// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One probability over all hypotheses together, "none of these" included.
#pragma once

#include <vector>

#include "evidence.hpp"

namespace loopmark {

/// Log-odds of one hypothesis against "none of these", from its features: a conditional logit model, fitted by
/// scripts/fit_confidence.py; docs/registration.md says on which pairs.
double log_odds(const Features& features);

/// P_i = exp(l_i) / (1 + sum_j exp(l_j)).
std::vector<double> probabilities(const std::vector<double>& log_odds);

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One probability over all hypotheses together, "none of these" included.
#pragma once

#include <array>
#include <vector>

#include "evidence.hpp"

namespace loopmark::registration::internal {

/// Kinds of scene in which the same evidence is worth more or less: little structure to ask about, much of it; sensors
/// near to each other, far apart; one scan of few beams, none; both of few, not both. What a beam misses 50 m away says
/// less than what it misses beside the car, and what sixteen beams miss less than what sixty-four do.
constexpr std::size_t kScenes = 8;

/// What a feature is worth in each scene: curves through eight points, flat beyond them.
struct WeightCurve {
  std::array<double, 8> at;
  std::array<std::array<double, 8>, kScenes> weight;
};

/// Log-odds of one hypothesis against "none of these", from its features: a conditional logit model whose weights vary
/// with the scene, fitted by scripts/fit_confidence.py; docs/results/registration.md says on which pairs.
double log_odds(const Features& features);

/// P_i = exp(l_i) / (1 + sum_j exp(l_j)).
std::vector<double> probabilities(const std::vector<double>& log_odds);

}  // namespace loopmark::registration::internal

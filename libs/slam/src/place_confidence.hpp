// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

#include "loopmark/registration/engine.hpp"
#include "loopmark/slam/place_beliefs.hpp"

namespace loopmark {

/// The engine's evidence by which answers at different places are compared (docs/registration.md says what each is).
constexpr std::array<std::string_view, 5> kCompared = {"agreement", "low_absence", "tall_clash", "far_conflict",
                                                       "ground_gap"};
constexpr double kMostLag =
    0.03;  ///< a signature's lag beyond it says no more: another sensor or a changed place may lag far
using Comparison = std::array<double, kCompared.size()>;

/// What speaks for one answer to "where in the map is this scan?".
struct PlaceVoices {
  double registration = 0.0;   ///< log-odds of the answer within its pair of scan and submap
  double support = 1.0;        ///< submaps of different places that give this answer
  double signature_lag = 0.0;  ///< distance of its place's signature beyond that of the most alike place
  Comparison beyond_best{};    ///< evidence minus that of the answer of which the engine is surest
};

/// `evidence` minus `best`; zero where either lacks a number.
Comparison compared(const Evidence& evidence, const Evidence& best);

/// Log-odds of the answer against "none of these", among all answers to the scan: the engine's, and linear in what else
/// speaks for one place rather than another, fitted by scripts/fit_places.py.
double place_log_odds(const PlaceVoices& voices);

/// The voices as named numbers, in the order that the fit expects.
Evidence evidence_of(const PlaceVoices& voices);

/// Log-odds against "none of these" of each mode of a pair, from the probabilities that the engine gave them.
std::vector<double> log_odds_of_modes(const RegistrationResult& result);

}  // namespace loopmark

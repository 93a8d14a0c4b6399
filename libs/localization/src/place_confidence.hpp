// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

#include "loopmark/localization/place_beliefs.hpp"
#include "loopmark/registration/engine.hpp"

namespace loopmark::localization::internal {

/// The engine's evidence by which answers at different places are compared (docs/reference/evidence.md says what each
/// is).
constexpr std::array<std::string_view, 5> kCompared = {"agreement", "low_missing", "tall_strong_violation",
                                                       "far_violation", "ground_gap"};
constexpr double kMostLag =
    0.03;  ///< a descriptor's lag beyond it says no more: another sensor or a changed place may lag far
using Comparison = std::array<double, kCompared.size()>;

/// What speaks for one answer to "where in the map is this scan?".
struct PlaceEvidence {
  double registration = 0.0;    ///< log-odds of the answer within its pair of scan and submap
  double support = 1.0;         ///< submaps of different places that give this answer
  double descriptor_lag = 0.0;  ///< distance of its place's descriptor beyond that of the most alike place
  Comparison beyond_best{};     ///< evidence minus that of the answer of which the engine is surest
};

/// `evidence` minus `best`; zero where either lacks a number.
Comparison compared(const registration::Evidence& evidence, const registration::Evidence& best);

/// Log-odds of the answer against "none of these", among all answers to the scan: the engine's, and linear in what else
/// speaks for one place rather than another, fitted by scripts/fit_places.py.
double place_log_odds(const PlaceEvidence& place_evidence);

/// The voices as named numbers, in the order that the fit expects.
registration::Evidence evidence_of(const PlaceEvidence& place_evidence);

/// Log-odds against "none of these" of each mode of a pair, from the probabilities that the engine gave them.
std::vector<double> log_odds_of_modes(const registration::RegistrationResult& result);

}  // namespace loopmark::localization::internal

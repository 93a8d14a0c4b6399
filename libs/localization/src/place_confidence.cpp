// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_confidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace loopmark::localization::internal {
namespace {

// Written by scripts/fit_places.py.
constexpr double kDescriptorLag = -101.5;
constexpr Comparison kBeyondBest = {8.57, -1.87, -0.216, -0.878, -24.6};  // in the order of kCompared

constexpr double kLeastP = 1e-9;

double number_named(const registration::Evidence& evidence, std::string_view name) {
  const auto found = std::find_if(evidence.begin(), evidence.end(), [&](const auto& e) { return e.first == name; });
  return found == evidence.end() ? std::nan("") : found->second;
}

}  // namespace

Comparison compared(const registration::Evidence& evidence, const registration::Evidence& best) {
  Comparison beyond{};
  for (std::size_t i = 0; i < kCompared.size(); ++i) {
    const double difference = number_named(evidence, kCompared[i]) - number_named(best, kCompared[i]);
    beyond[i] = std::isfinite(difference) ? difference : 0.0;
  }
  return beyond;
}

double place_log_odds(const PlaceEvidence& place_evidence) {
  return place_evidence.registration + kDescriptorLag * std::min(place_evidence.descriptor_lag, kMostLag) +
         std::inner_product(kBeyondBest.begin(), kBeyondBest.end(), place_evidence.beyond_best.begin(), 0.0);
}

registration::Evidence evidence_of(const PlaceEvidence& place_evidence) {
  return {{"registration", place_evidence.registration},
          {"submaps", place_evidence.support},
          {"descriptor_lag", place_evidence.descriptor_lag}};
}

std::vector<double> log_odds_of_modes(const registration::RegistrationResult& result) {
  double none = 1.0;
  for (const registration::RegistrationMode& mode : result.modes) {
    none -= mode.p_correct;
  }
  std::vector<double> log_odds;
  for (const registration::RegistrationMode& mode : result.modes) {
    log_odds.push_back(std::log(std::max(mode.p_correct, kLeastP) / std::max(none, kLeastP)));
  }
  return log_odds;
}

}  // namespace loopmark::localization::internal

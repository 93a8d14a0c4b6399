// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_confidence.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
namespace {

constexpr double kBias = 0.0;
constexpr double kRegistration = 1.0;
constexpr double kSupport = 0.0;
constexpr double kSignatureLag = 0.0;

constexpr double kLeastP = 1e-9;

}  // namespace

double place_log_odds(const PlaceVoices& voices) {
  return kBias + kRegistration * voices.registration + kSupport * std::log(voices.support) +
         kSignatureLag * voices.signature_lag;
}

Evidence evidence_of(const PlaceVoices& voices) {
  return {{"registration", voices.registration}, {"support", voices.support}, {"signature_lag", voices.signature_lag}};
}

std::vector<double> log_odds_of_modes(const RegistrationResult& result) {
  double none = 1.0;
  for (const RegistrationMode& mode : result.modes) {
    none -= mode.p_correct;
  }
  std::vector<double> log_odds;
  for (const RegistrationMode& mode : result.modes) {
    log_odds.push_back(std::log(std::max(mode.p_correct, kLeastP) / std::max(none, kLeastP)));
  }
  return log_odds;
}

}  // namespace loopmark

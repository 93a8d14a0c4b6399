// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/estimate.hpp"

#include <cstdio>

#include "loopmark/core/number_text.hpp"

namespace loopmark::estimation {

const char* to_string(EstimateStop stop) {
  switch (stop) {
    case EstimateStop::kDone:
      return "done";
    case EstimateStop::kConfident:
      return "confident";
    case EstimateStop::kIterationLimit:
      return "iteration limit";
    case EstimateStop::kTimeLimit:
      return "time limit";
    case EstimateStop::kTooFewMatches:
      return "too few matches";
  }
  return "";
}

std::string Estimate::summary() const {
  return format_text("%s: %zu inliers, score %.1f, %zu iterations, %zu models, %zu scored, %.4f s", to_string(stop),
                     inliers.size(), score, iterations, models, scored, seconds);
}

}  // namespace loopmark::estimation

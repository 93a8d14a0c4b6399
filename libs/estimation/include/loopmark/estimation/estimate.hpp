// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::estimation {

/// Why an estimator came to an end.
enum class EstimateStop { kDone, kConfident, kIterationLimit, kTimeLimit, kTooFewMatches };
const char* to_string(EstimateStop stop);

/// The outcome of a robust estimation over matches.
struct Estimate {
  Pose T_target_source = Pose::Identity();
  bool found = false;  ///< false: nothing better than nothing; the motion is the identity
  EstimateStop stop = EstimateStop::kDone;
  std::vector<std::size_t> inliers;  ///< places in the matches, residual below the threshold
  double score = 0.0;                ///< the estimator's own; comparable only between results of one estimator
  std::size_t iterations = 0;
  std::size_t models = 0;  ///< motions that were solved for
  std::size_t scored = 0;  ///< motions that were scored to the end
  double seconds = 0.0;    ///< wall time; not part of what is deterministic

  /// One line for logs.
  std::string summary() const;
};

}  // namespace loopmark::estimation

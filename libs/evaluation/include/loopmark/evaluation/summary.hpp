// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The numbers of an experiment, by algorithm.
#pragma once

#include <string>
#include <vector>

#include "loopmark/evaluation/outcome.hpp"
#include "loopmark/statistics/statistics.hpp"

namespace loopmark::evaluation {

/// A pair of an experiment, as far as the statistics need it.
struct EvaluatedSet {
  std::vector<pair_sets::RegistrationPair> pairs;
  std::vector<pair_sets::PairKey> negatives;

  std::size_t size() const { return pairs.size() + negatives.size(); }
  const pair_sets::PairKey& key(std::size_t index) const {
    return index < pairs.size() ? pairs[index].key : negatives[index - pairs.size()];
  }
};

/// Recall within one bin of overlap, distance, ...
struct RecallBin {
  double low = 0.0;
  double high = 0.0;
  std::size_t pairs = 0;
  std::size_t successes = 0;
  double recall() const { return pairs == 0 ? 0.0 : static_cast<double>(successes) / static_cast<double>(pairs); }
};

/// All that is said of one algorithm.
struct AlgorithmSummary {
  std::string name;
  std::size_t pairs = 0;
  std::size_t successes = 0;
  statistics::Interval recall_interval;  ///< Wilson, 95 %
  std::size_t answered = 0;              ///< positives that it stood for
  std::size_t answered_wrong = 0;        ///< of these, the wrong ones
  std::size_t failed = 0;                ///< no motion: failure, time limit, crash
  statistics::Spread te_m, re_deg;       ///< over all pairs
  statistics::Spread te_success_m, re_success_deg;
  statistics::Interval te_median_interval_m;  ///< bootstrap, 95 %
  statistics::Interval re_median_interval_deg;
  statistics::Spread paper_seconds, total_seconds;
  std::vector<std::pair<std::string, double>> stage_medians_s;  ///< median seconds of each stage
  std::vector<std::pair<std::string, double>> number_means;     ///< mean of each number of the answers
  std::size_t negatives = 0;
  std::size_t false_accepts = 0;  ///< negatives that it stood for
  statistics::Interval false_accept_interval;
  bool has_scores = false;  ///< it gives P(correct) or a score
  std::vector<statistics::ReliabilityBin> reliability;
  double calibration_error = 0.0;
  std::vector<statistics::PrecisionRecallPoint> precision_recall;
  double average_precision = 0.0;
  std::vector<RecallBin> by_overlap;   ///< symmetric overlap
  std::vector<RecallBin> by_distance;  ///< metres
  std::vector<RecallBin> by_yaw;       ///< |yaw|, degrees

  double recall() const { return pairs == 0 ? 0.0 : static_cast<double>(successes) / static_cast<double>(pairs); }
  double false_accept_rate() const {
    return negatives == 0 ? 0.0 : static_cast<double>(false_accepts) / static_cast<double>(negatives);
  }
};

/// Summarises the outcomes of one algorithm (all of the same name, any order).
AlgorithmSummary summarise(const std::vector<Outcome>& outcomes, const EvaluatedSet& set);

/// Groups by algorithm, in the order of `names`.
std::vector<AlgorithmSummary> summarise_all(const std::vector<Outcome>& outcomes, const std::vector<std::string>& names,
                                            const EvaluatedSet& set);

/// The paired comparison of two algorithms on the pairs that both have tried.
struct PairedTest {
  std::string first, second;
  std::size_t both = 0, only_first = 0, only_second = 0, neither = 0;
  double p_value = 1.0;  ///< McNemar, exact, two-sided
};
PairedTest paired_test(const std::vector<Outcome>& outcomes, const std::string& first, const std::string& second);

/// Every two algorithms, in the order of `names`.
std::vector<PairedTest> paired_tests(const std::vector<Outcome>& outcomes, const std::vector<std::string>& names);

}  // namespace loopmark::evaluation

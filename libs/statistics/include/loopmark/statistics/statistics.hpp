// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The statistics of an experiment: intervals, paired tests, quantiles, calibration.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace loopmark::statistics {

/// A two-sided interval.
struct Interval {
  double low = 0.0;
  double high = 1.0;
};

/// Wilson's score interval of a share of `successes` in `count` trials (E. B. Wilson, 1927), 95 % for the
/// default z. [0, 1] when there are no trials.
Interval wilson_interval(std::size_t successes, std::size_t count, double z = 1.959963984540054);

/// Percentile bootstrap of any statistic of a sample, 95 %: `repeats` samples drawn with replacement.
Interval bootstrap_interval(const std::vector<double>& sample,
                            const std::function<double(const std::vector<double>&)>& statistic,
                            std::size_t repeats = 1000, std::uint64_t seed = 0);

/// McNemar's exact test of two algorithms on the same pairs: `only_first` pairs where only the first succeeded,
/// `only_second` where only the second did. Two-sided p-value of the binomial with probability 1/2.
double mcnemar_p_value(std::size_t only_first, std::size_t only_second);

/// Quantile with linear interpolation between order statistics (type 7 of Hyndman and Fan). NaN of nothing.
double quantile(std::vector<double> values, double share);

/// Mean, median and 95th percentile; NaN of nothing.
struct Spread {
  double mean = 0.0;
  double median = 0.0;
  double p95 = 0.0;
};
Spread spread_of(const std::vector<double>& values);

/// Pearson's chi-square statistic of counts against equal shares, divided by the number of counts minus one:
/// about 1 for a uniform draw, larger the less even the bins are.
double unevenness(const std::vector<std::size_t>& counts);

/// An answer with the probability that its author gave it.
struct Judged {
  double p_correct = 0.0;
  bool correct = false;
};

/// One bin of a reliability diagram.
struct ReliabilityBin {
  double low = 0.0;
  double high = 0.0;
  std::size_t count = 0;
  double mean_p = 0.0;         ///< mean stated probability
  double share_correct = 0.0;  ///< share that was right
};

/// Bins of equal width over [0, 1]; the last includes 1.
std::vector<ReliabilityBin> reliability_table(const std::vector<Judged>& answers, std::size_t bins = 10);

/// Expected calibration error: mean over answers of |share_correct - mean_p| of their bin.
double expected_calibration_error(const std::vector<ReliabilityBin>& table);

/// One point of a precision-recall curve: answers with p_correct >= threshold are given.
struct PrecisionRecallPoint {
  double threshold = 0.0;
  double precision = 1.0;  ///< right among the given (1 when none is given)
  double recall = 0.0;     ///< right and given, among `positives`
};

/// The curve over all distinct thresholds, from the highest down. `positives`: pairs that have a right answer.
std::vector<PrecisionRecallPoint> precision_recall(std::vector<Judged> answers, std::size_t positives);

/// Area under the curve by its steps (average precision).
double average_precision(const std::vector<PrecisionRecallPoint>& curve);

}  // namespace loopmark::statistics

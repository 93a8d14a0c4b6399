// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "loopmark/core/random.hpp"

namespace loopmark::statistics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double log_binomial(double n, double k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

}  // namespace

Interval wilson_interval(std::size_t successes, std::size_t count, double z) {
  if (count == 0) {
    return {0.0, 1.0};
  }
  const double n = static_cast<double>(count);
  const double share = static_cast<double>(successes) / n;
  const double scale = 1.0 / (1.0 + z * z / n);
  const double centre = scale * (share + z * z / (2.0 * n));
  const double half = scale * z * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n));
  return {successes == 0 ? 0.0 : std::max(0.0, centre - half), successes == count ? 1.0 : std::min(1.0, centre + half)};
}

Interval bootstrap_interval(const std::vector<double>& sample,
                            const std::function<double(const std::vector<double>&)>& statistic, std::size_t repeats,
                            std::uint64_t seed) {
  if (sample.empty()) {
    return {kNaN, kNaN};
  }
  Rng rng(task_seed(seed, {0x626f6f74U, sample.size()}));
  std::vector<double> values(repeats);
  std::vector<double> drawn(sample.size());
  for (double& value : values) {
    for (double& item : drawn) {
      item = sample[rng.below(static_cast<std::uint32_t>(sample.size()))];
    }
    value = statistic(drawn);
  }
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

double mcnemar_p_value(std::size_t only_first, std::size_t only_second) {
  const std::size_t discordant = only_first + only_second;
  const double n = static_cast<double>(discordant);
  double tail = 0.0;
  for (std::size_t k = 0; k <= std::min(only_first, only_second); ++k) {
    tail += std::exp(log_binomial(n, static_cast<double>(k)) - n * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return kNaN;
  }
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

Spread spread_of(const std::vector<double>& values) {
  if (values.empty()) {
    return {kNaN, kNaN, kNaN};
  }
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {sum / static_cast<double>(values.size()), quantile(values, 0.5), quantile(values, 0.95)};
}

double unevenness(const std::vector<std::size_t>& counts) {
  const double total = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
  if (counts.size() < 2 || total == 0.0) {
    return 0.0;
  }
  const double expected = total / static_cast<double>(counts.size());
  double chi2 = 0.0;
  for (const std::size_t count : counts) {
    chi2 += (static_cast<double>(count) - expected) * (static_cast<double>(count) - expected) / expected;
  }
  return chi2 / static_cast<double>(counts.size() - 1);
}

std::vector<ReliabilityBin> reliability_table(const std::vector<Judged>& answers, std::size_t bins) {
  std::vector<ReliabilityBin> table(bins);
  for (std::size_t b = 0; b < bins; ++b) {
    table[b].low = static_cast<double>(b) / static_cast<double>(bins);
    table[b].high = static_cast<double>(b + 1) / static_cast<double>(bins);
  }
  for (const Judged& answer : answers) {
    const double p = std::clamp(answer.p_correct, 0.0, 1.0);
    ReliabilityBin& bin = table[std::min(static_cast<std::size_t>(p * static_cast<double>(bins)), bins - 1)];
    ++bin.count;
    bin.mean_p += p;
    bin.share_correct += answer.correct ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : table) {
    if (bin.count > 0) {
      bin.mean_p /= static_cast<double>(bin.count);
      bin.share_correct /= static_cast<double>(bin.count);
    }
  }
  return table;
}

double expected_calibration_error(const std::vector<ReliabilityBin>& table) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const ReliabilityBin& bin : table) {
    sum += static_cast<double>(bin.count) * std::abs(bin.share_correct - bin.mean_p);
    count += bin.count;
  }
  return count == 0 ? kNaN : sum / static_cast<double>(count);
}

std::vector<PrecisionRecallPoint> precision_recall(std::vector<Judged> answers, std::size_t positives) {
  std::sort(answers.begin(), answers.end(), [](const Judged& a, const Judged& b) { return a.p_correct > b.p_correct; });
  std::vector<PrecisionRecallPoint> curve;
  std::size_t given = 0;
  std::size_t right = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ++given;
    right += answers[i].correct ? 1 : 0;
    if (i + 1 < answers.size() && answers[i + 1].p_correct == answers[i].p_correct) {
      continue;
    }
    curve.push_back({answers[i].p_correct, static_cast<double>(right) / static_cast<double>(given),
                     positives == 0 ? 0.0 : static_cast<double>(right) / static_cast<double>(positives)});
  }
  return curve;
}

double average_precision(const std::vector<PrecisionRecallPoint>& curve) {
  double area = 0.0;
  double recall = 0.0;
  for (const PrecisionRecallPoint& point : curve) {
    area += point.precision * (point.recall - recall);
    recall = point.recall;
  }
  return area;
}

}  // namespace loopmark::statistics

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/statistics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "loopmark/core/random.hpp"

namespace loopmark::statistics {
namespace {

TEST(Wilson, AgreesWithTheLiterature) {
  // Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in Medicine 17 (1998), Table I.
  const Interval a = wilson_interval(81, 263);
  EXPECT_NEAR(a.low, 0.2553, 5e-5);
  EXPECT_NEAR(a.high, 0.3662, 5e-5);
  const Interval b = wilson_interval(15, 148);
  EXPECT_NEAR(b.low, 0.0624, 5e-5);
  EXPECT_NEAR(b.high, 0.1605, 5e-5);
  const Interval c = wilson_interval(0, 20);
  EXPECT_NEAR(c.low, 0.0, 1e-12);
  EXPECT_NEAR(c.high, 0.1611, 5e-5);
  EXPECT_NEAR(wilson_interval(1, 29).low, 0.0061, 5e-5);
}

TEST(Wilson, CoversTheTruthAboutAsOftenAsItSays) {
  Rng rng(5);
  int covered = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::size_t successes = 0;
    for (int i = 0; i < 60; ++i) {
      successes += rng.uniform() < 0.9 ? 1 : 0;
    }
    const Interval interval = wilson_interval(successes, 60);
    covered += interval.low <= 0.9 && 0.9 <= interval.high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(covered) / kTrials, 0.95, 0.025);
}

TEST(Bootstrap, OfAMeanIsAboutItsNormalInterval) {
  Rng rng(9);
  std::vector<double> sample(400);
  for (double& value : sample) {
    value = rng.normal();
  }
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  const Interval interval = bootstrap_interval(sample, mean, 2000, 1);
  EXPECT_NEAR(interval.high - interval.low, 2.0 * 1.96 / std::sqrt(400.0), 0.025);
  const Interval again = bootstrap_interval(sample, mean, 2000, 1);
  EXPECT_EQ(interval.low, again.low);
}

TEST(McNemar, IsTheBinomialTest) {
  EXPECT_DOUBLE_EQ(mcnemar_p_value(0, 0), 1.0);
  EXPECT_NEAR(mcnemar_p_value(0, 5), 2.0 / 32.0, 1e-12);
  EXPECT_NEAR(mcnemar_p_value(1, 5), 2.0 * 7.0 / 64.0, 1e-12);
  EXPECT_DOUBLE_EQ(mcnemar_p_value(4, 4), 1.0);
  EXPECT_DOUBLE_EQ(mcnemar_p_value(3, 17), mcnemar_p_value(17, 3));
  EXPECT_LT(mcnemar_p_value(100, 300), 1e-20);
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({0.0, 10.0}, 0.95), 9.5);
  EXPECT_DOUBLE_EQ(quantile({7.0}, 0.95), 7.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Unevenness, IsZeroForEqualBinsAndAboutOneForChance) {
  EXPECT_DOUBLE_EQ(unevenness({5, 5, 5, 5}), 0.0);
  Rng rng(3);
  std::vector<std::size_t> counts(100);
  for (int i = 0; i < 10000; ++i) {
    ++counts[rng.below(100)];
  }
  EXPECT_NEAR(unevenness(counts), 1.0, 0.5);
}

TEST(Calibration, OfHonestProbabilitiesIsSmall) {
  Rng rng(11);
  std::vector<Judged> honest;
  std::vector<Judged> boastful;
  for (int i = 0; i < 20000; ++i) {
    const double p = rng.uniform();
    const bool right = rng.uniform() < p;
    honest.push_back({p, right});
    boastful.push_back({std::min(1.0, p + 0.3), right});
  }
  EXPECT_LT(expected_calibration_error(reliability_table(honest)), 0.02);
  EXPECT_GT(expected_calibration_error(reliability_table(boastful)), 0.2);
}

TEST(Calibration, ByHand) {
  const auto table = reliability_table({{0.05, false}, {0.95, true}, {0.91, false}, {1.0, true}}, 10);
  EXPECT_EQ(table[9].count, 3U);
  EXPECT_NEAR(table[9].mean_p, (0.95 + 0.91 + 1.0) / 3.0, 1e-12);
  EXPECT_NEAR(expected_calibration_error(table), 0.25 * 0.05 + 0.75 * std::abs(2.0 / 3.0 - 2.86 / 3.0), 1e-12);
}

TEST(PrecisionRecall, ByHand) {
  const auto curve = precision_recall({{0.9, true}, {0.8, false}, {0.8, true}, {0.1, false}}, 4);
  ASSERT_EQ(curve.size(), 3U);
  EXPECT_DOUBLE_EQ(curve[0].precision, 1.0);
  EXPECT_DOUBLE_EQ(curve[0].recall, 0.25);
  EXPECT_DOUBLE_EQ(curve[1].precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(curve[1].recall, 0.5);
  EXPECT_DOUBLE_EQ(average_precision(curve), 0.25 + 0.25 * 2.0 / 3.0);
}

}  // namespace
}  // namespace loopmark::statistics

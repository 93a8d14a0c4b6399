// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopmark::report {
namespace {

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks) {
    result.push_back(tick.label);
  }
  return result;
}

TEST(Ticks, AreRoundNumbers) {
  EXPECT_EQ(labels(linear_ticks(0.0, 10.0, 5)), (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels(linear_ticks(-0.12, 0.11, 4)), (std::vector<std::string>{"-0.1", "0.0", "0.1"}));
  EXPECT_EQ(labels(linear_ticks(0.0, 4e-13, 2)), (std::vector<std::string>{"0", "2e-13", "4e-13"}));
  EXPECT_EQ(labels(linear_ticks(2.3e6, 2.7e6, 2)), (std::vector<std::string>{"2.4e+06", "2.6e+06"}));
}

TEST(Ticks, StayInRangeAndAreNeverTooMany) {
  for (const double low : {-1e9, -3.7, 0.0, 1e-7}) {
    for (const double spread : {1e-6, 0.3, 17.0, 1e12}) {
      const auto ticks = linear_ticks(low, low + spread, 6);
      EXPECT_LE(ticks.size(), 8U) << low << " " << spread;
      EXPECT_GE(ticks.size(), 2U) << low << " " << spread;
      for (const Tick& tick : ticks) {
        EXPECT_GE(tick.value, low - 1e-6 * spread);
        EXPECT_LE(tick.value, low + spread + 1e-6 * spread);
      }
    }
  }
}

TEST(Ticks, LogarithmicNumbersPowersOnlyWhereThereAreMany) {
  EXPECT_EQ(labels(logarithmic_ticks(1.0, 10.0)),
            (std::vector<std::string>{"1", "2", "", "", "5", "", "", "", "", "10"}));
  for (const Tick& tick : logarithmic_ticks(1e-3, 1e3)) {
    const bool power = std::abs(std::log10(tick.value) - std::round(std::log10(tick.value))) < 1e-9;
    EXPECT_EQ(!tick.label.empty(), power) << tick.value;
  }
}

}  // namespace
}  // namespace loopmark::report

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/number_text.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdio>
#include <limits>

#include "loopmark/core/random.hpp"

namespace loopmark {
namespace {

/// printf is the oracle: this program speaks the C locale.
std::string by_printf(const char* form, double value) {
  char text[400];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

TEST(NumberText, IsThatOfPrintfAndComesBackToTheBit) {
  Rng rng(3);
  std::vector<double> values = {0.0, -0.0, 1.0, -1.0, 5e-324, 1.7976931348623157e308, 0.1};
  for (int i = 0; i < 2000; ++i) {
    values.push_back((rng.uniform() - 0.5) * std::pow(10.0, rng.uniform(-300.0, 300.0)));
  }
  for (const double value : values) {
    EXPECT_EQ(exact_text(value), by_printf("%a", value));
    const std::optional<double> back = number_in(exact_text(value));
    ASSERT_TRUE(back.has_value()) << value;
    EXPECT_EQ(*back, value);
    EXPECT_EQ(std::signbit(*back), std::signbit(value));
    EXPECT_EQ(number_in(by_printf("%.17g", value)), value);
    EXPECT_EQ(format_text("%.9g", value), by_printf("%.9g", value));
  }
  EXPECT_EQ(exact_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_TRUE(std::isnan(*number_in("nan")));
  EXPECT_EQ(number_in("-inf"), -std::numeric_limits<double>::infinity());
}

TEST(NumberText, WhatIsNoNumberIsNone) {
  for (const char* text : {"", "-", "0x", "--1", "-+1", "1,5", "1 ", " 1", "1.5x", "0x1p", "1e999", "abc"}) {
    EXPECT_FALSE(number_in(text).has_value()) << '"' << text << '"';
  }
  EXPECT_EQ(number_in("+1.5"), 1.5);
}

TEST(NumberText, KnowsNoComma) {
  const char* const kept = std::setlocale(LC_ALL, nullptr);
  const std::string before = kept;
  bool found = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) {
    found = found || std::setlocale(LC_ALL, name) != nullptr;
  }
  if (!found) {
    GTEST_SKIP() << "no locale with a decimal comma is installed";
  }
  EXPECT_EQ(by_printf("%.1f", 0.5), "0,5") << "else this test shows nothing";
  EXPECT_EQ(format_text("%.1f", 0.5), "0.5");
  EXPECT_EQ(exact_text(1.5), "0x1.8p+0");
  EXPECT_EQ(number_in("0x1.8p+0"), 1.5);
  EXPECT_EQ(number_in("0.5"), 0.5);
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace loopmark

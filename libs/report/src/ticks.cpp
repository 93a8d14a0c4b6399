// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "loopmark/core/number_text.hpp"
#include "text.hpp"

namespace loopmark::report {
namespace {

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

std::string number_label(double value, double step) {
  const double size = std::abs(value);
  if (size < 1e-9 * step) {
    value = 0.0;
  }
  if (size >= 1e6 || step < 1e-4) {
    return format_text("%g", value);
  }
  return internal::fixed(value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, std::size_t wanted) {
  const double step = round_step((high - low) / static_cast<double>(std::max<std::size_t>(wanted, 1)));
  const double slack = 1e-9 * (high - low);
  std::vector<Tick> ticks;
  const double first = std::ceil((low - slack) / step);
  for (double i = first; i * step <= high + slack && ticks.size() < 100; ++i) {
    ticks.push_back({i * step, number_label(i * step, step)});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double low, double high) {
  const double first = std::floor(std::log10(low) + 1e-9);
  const double last = std::ceil(std::log10(high) - 1e-9);
  const bool few = last - first <= 2.0;
  std::vector<Tick> ticks;
  for (double exponent = first; exponent <= last; ++exponent) {
    const double power = std::pow(10.0, exponent);
    for (int factor = 1; factor < 10; ++factor) {
      const double value = factor * power;
      if (value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9)) {
        const bool numbered = factor == 1 || (few && (factor == 2 || factor == 5));
        ticks.push_back({value, numbered ? number_label(value, value) : std::string()});
      }
    }
  }
  return ticks;
}

}  // namespace loopmark::report

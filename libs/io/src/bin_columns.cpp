// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "bin_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

namespace loopmark::io::internal {
namespace {

constexpr std::size_t kMostValues = 60'000;  ///< that are looked at; a multiple of 3, 4, 5 and 6
constexpr std::size_t kLeastValues = 600;
constexpr double kLeastShare = 0.05;  ///< of the variance that the place in a point explains, where there are points
constexpr double kStandsOut = 2.0;    ///< times what another period explains

/// What tells the kinds of values apart, whatever their units: below zero, whole, small, and their order of magnitude.
std::array<double, 4> traits_of(float value) {
  const double size = std::abs(static_cast<double>(value));
  return {value < 0.0F ? 1.0 : 0.0, value == std::floor(value) ? 1.0 : 0.0, size <= 1.0 ? 1.0 : 0.0,
          std::log1p(std::min(size, 1e6)) / std::log(1e6)};
}

/// Share of the variance of the traits that lies between the places in a point of `period` values.
double explained_by(std::span<const std::array<double, 4>> values, std::size_t period) {
  double best = 0.0;
  for (std::size_t trait = 0; trait < 4; ++trait) {
    std::vector<double> sums(period, 0.0);
    std::vector<double> counts(period, 0.0);
    double squares = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = values[i][trait];
      sums[i % period] += value;
      counts[i % period] += 1.0;
      squares += value * value;
      sum += value;
    }
    const auto count = static_cast<double>(values.size());
    const double whole = squares / count - (sum / count) * (sum / count);
    double between = 0.0;
    for (std::size_t k = 0; k < period; ++k) {
      between += counts[k] / count * std::pow(sums[k] / counts[k] - sum / count, 2);
    }
    best = std::max(best, whole > 1e-12 ? between / whole : 0.0);
  }
  return best;
}

}  // namespace

std::optional<std::size_t> columns_shown_by(std::span<const char> bytes) {
  const std::size_t count = std::min(bytes.size() / sizeof(float), kMostValues);
  if (count < kLeastValues) {
    return std::nullopt;
  }
  std::vector<std::array<double, 4>> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    float value = 0.0F;
    std::memcpy(&value, bytes.data() + i * sizeof(float), sizeof value);
    if (!std::isfinite(value)) {
      return std::nullopt;  // records of another kind
    }
    values[i] = traits_of(value);
  }
  std::array<double, 7> share{};
  for (std::size_t period = 3; period <= 6; ++period) {
    share[period] = explained_by(values, period);
  }
  const std::size_t best = static_cast<std::size_t>(std::max_element(share.begin() + 3, share.end()) - share.begin());
  for (std::size_t period = 3; period <= 6; ++period) {
    const bool repeats = best % period == 0;  // three values a point repeat with every six, too
    if (period != best && !repeats && share[best] < kStandsOut * share[period]) {
      return std::nullopt;
    }
  }
  if (share[best] < kLeastShare) {
    return std::nullopt;
  }
  return best == 6 && share[3] > 0.8 * share[6] ? 3 : best;
}

}  // namespace loopmark::io::internal

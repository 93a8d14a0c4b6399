// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "confidence.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
namespace {

constexpr double kBias = -20.0;
constexpr Features kWeights = {4, 3, -8, 4, -20, 3, 4, 0, 0, 0.7, 1.0, 5};

}  // namespace

double log_odds(const Features& features) {
  double sum = kBias;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    sum += kWeights[i] * features[i];
  }
  return sum;
}

std::vector<double> probabilities(const std::vector<double>& log_odds) {
  double highest = 0.0;  // of "none of these"
  for (const double l : log_odds) {
    highest = std::max(highest, l);
  }
  double total = std::exp(-highest);
  for (const double l : log_odds) {
    total += std::exp(l - highest);
  }
  std::vector<double> p;
  for (const double l : log_odds) {
    p.push_back(std::exp(l - highest) / total);
  }
  return p;
}

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "confidence.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
namespace {

constexpr double kBias = -15.4931;
constexpr Features kWeights = {7.6371, 0.7944, -1.8702, 0.0,    -1.3544, 0.0,     0.0,
                               0.0,    0.0390, 0.0,     2.0580, 0.0,     -13.8401};

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

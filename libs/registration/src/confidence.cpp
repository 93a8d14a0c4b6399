// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "confidence.hpp"

#include <algorithm>
#include <cmath>

#include "confidence_curves.hpp"

namespace loopmark::registration::internal {
namespace {

/// How much of each scene a hypothesis is; each two are shares of one.
std::array<double, kScenes> mixture_weights(const Features& features) {
  const auto rise = [](double value, double from, double to) {
    return std::clamp((value - from) / (to - from), 0.0, 1.0);
  };
  const double apart_m = -10.0 * std::log(std::max(feature(features, "proximity"), 1e-9));
  const double much = rise(feature(features, "structure_fewer"), kLittle, kMuch);
  const double far = rise(apart_m, kNear, kFar);
  const double both_dense = rise(feature(features, "density_ratio"), kSparse, kDense);
  const double one_dense = rise(feature(features, "density_ratio_more"), kBothSparse, kOneDense);
  return {1.0 - much, much, 1.0 - far, far, 1.0 - both_dense, both_dense, 1.0 - one_dense, one_dense};
}

/// The value of a feature's curves, mixed by the shares of the scenes.
double weight_of(const WeightCurve& w, double value, const std::array<double, kScenes>& shares) {
  const auto above = static_cast<std::size_t>(std::upper_bound(w.at.begin(), w.at.end(), value) - w.at.begin());
  const std::size_t i = std::clamp<std::size_t>(above, 1, w.at.size() - 1);
  const double t = std::clamp((value - w.at[i - 1]) / (w.at[i] - w.at[i - 1]), 0.0, 1.0);
  double sum = 0.0;
  for (std::size_t s = 0; s < kScenes; ++s) {
    sum += shares[s] * (w.weight[s][i - 1] + t * (w.weight[s][i] - w.weight[s][i - 1]));
  }
  return sum;
}

/// The absolute floor. Scans that share hardly any structure and no ground touch at their fringe, if at all: one wall
/// end may fit as neatly as it likes. None of 1619 right motions of the pairs that served the fit lies below it.
constexpr double kLeastAgreement = 0.08;
const double kLeastGround = std::log1p(30.0);
constexpr double kFringe = 5.0;

}  // namespace

double log_odds(const Features& features) {
  const auto shares = mixture_weights(features);
  double sum = 0.0;
  for (std::size_t s = 0; s < kScenes; ++s) {
    sum += shares[s] * kBias[s];
  }
  for (std::size_t i = 0; i < kWeighed; ++i) {
    sum += weight_of(kWeightCurves[i], features[i], shares);
  }
  const bool fringe = feature(features, "agreement") < kLeastAgreement && feature(features, "ground") < kLeastGround;
  return fringe ? sum - kFringe : sum;
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

}  // namespace loopmark::registration::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "confidence.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
namespace {

/// What a feature is worth: a curve through eight points, flat beyond them.
struct Worth {
  std::array<double, 8> at;
  std::array<double, 8> worth;

  double of(double feature) const {
    if (!(feature > at.front())) {
      return worth.front();
    }
    for (std::size_t i = 1; i < at.size(); ++i) {
      if (feature < at[i]) {
        return worth[i - 1] + (worth[i] - worth[i - 1]) * (feature - at[i - 1]) / (at[i] - at[i - 1]);
      }
    }
    return worth.back();
  }
};

// Written by scripts/fit_confidence.py, in the order of kFeatureNames.
// clang-format off
constexpr double kBias = -3.828;
constexpr std::array<Worth, kFeatures> kWorth = {{
    {{0.00025, 0.03275, 0.07275, 0.1225, 0.2008, 0.2555, 0.3375, 0.531}, {0, 0.5323, 1.127, 1.901, 2.466, 2.466, 2.466, 2.466}},  // agreement
    {{-4.168, -3.352, -2.936, -2.477, -1.738, -1.273, -0.9135, -0.4445}, {0, -0.07453, -0.5451, -1.009, -2.261, -3.427, -4.092, -4.539}},  // low_absence
    {{-7.125, -6.097, -5.308, -4.542, -1.705, -0.8602, -0.473, -0.1267}, {0, -0.05121, -0.4541, -0.725, -0.8498, -0.8498, -0.8753, -0.8988}},  // tall_clash
    {{-6.147, -3.932, -2.908, -2.034, -0.964, -0.5377, -0.3209, -0.1297}, {0, -0.07581, -0.51, -1.054, -1.297, -1.297, -1.297, -1.297}},  // object_clash
    {{-5.607, -3.74, -2.944, -2.303, -0.7885, -0.3171, -0.1761, -0.0732}, {0, -0.855, -1.866, -2.705, -3.136, -3.136, -3.136, -3.136}},  // far_conflict
    {{0, 0.6931, 1.099, 1.792, 2.996, 3.714, 3.989, 4.407}, {0, -0.1054, -0.2578, -0.9539, -2.13, -2.743, -2.942, -3.084}},  // contradicted
    {{0, 1e-06, 2e-06, 3e-06, 0.6932, 2.197, 3.045, 3.664}, {0, -0.3805, -0.7753, -1.205, -1.71, -2.365, -2.645, -2.84}},  // tall_contradicted
    {{0, 0.05117, 0.06001, 0.06763, 0.07681, 0.08376, 0.09239, 0.1399}, {0, -1.765, -2.775, -3.276, -3.276, -3.276, -3.276, -3.276}},  // residual
    {{0, 1.609, 2.639, 3.434, 4.174, 5.011, 5.894, 6.8}, {0, 2.512, 3.802, 3.802, 3.802, 3.802, 4.031, 4.031}},  // objects
    {{0, 2.944, 4.094, 4.956, 5.642, 6.189, 6.575, 7.29}, {0, 0, 0.08024, 0.6177, 1.028, 1.028, 1.028, 1.028}},  // tall_support
    {{0, 1.792, 2.833, 3.784, 4.913, 5.501, 5.974, 6.737}, {0, 0.8134, 1.475, 1.64, 1.64, 1.64, 1.64, 1.64}},  // far_support
    {{-5.625, -3, -1.25, 1.188, 4.75, 8.125, 11.5, 19.25}, {0, 0.3036, 0.7475, 1.599, 2.055, 2.055, 2.055, 2.055}},  // landmarks
    {{0, 1e-06, 8.033, 10.76, 22.13, 30.79, 40.06, 60}, {0, 0, 0, 0.4035, 1.31, 1.31, 1.31, 1.31}},  // peak
    {{0, 1e-06, 0.2406, 0.4966, 1, 1, 1, 1}, {0, 0, 0.4809, 2.256, 4.447, 5.567, 6.18, 6.591}},  // lead
    {{0, 3.689, 4.407, 4.89, 5.371, 5.72, 6.026, 6.447}, {0, 0.8434, 1.305, 1.619, 1.619, 1.619, 1.619, 1.619}},  // ground
    {{0.01754, 0.03806, 0.05054, 0.06656, 0.08636, 0.1, 0.1133, 0.14}, {0, -0.8261, -1.206, -1.353, -1.57, -1.57, -1.57, -1.57}},  // ground_gap
    {{5.495e-05, 0.007084, 0.0181, 0.04051, 0.08916, 0.1533, 0.2805, 0.9413}, {0, -0, -0, -0.3245, -0.8675, -1.563, -3.233, -6.885}},  // near
}};
// clang-format on

/// The absolute floor. Scans that share hardly any structure and no ground touch at their fringe, if at all: one wall
/// end may fit as neatly as it likes. None of 1619 right motions of the pairs that served the fit lies below it.
constexpr double kLeastAgreement = 0.08;
const double kLeastGround = std::log1p(30.0);
constexpr double kFringe = 5.0;

}  // namespace

double log_odds(const Features& features) {
  double sum = kBias;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    sum += kWorth[i].of(features[i]);
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

}  // namespace loopmark

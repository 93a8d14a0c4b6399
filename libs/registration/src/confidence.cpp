// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "confidence.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark {
namespace {

/// What a feature is worth: a curve through six points, flat beyond them.
struct Worth {
  std::array<double, 6> at;
  std::array<double, 6> worth;

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
constexpr double kBias = -2.680;
constexpr std::array<Worth, kFeatures> kWorth = {{
    {{0, 0.048, 0.0775, 0.1115, 0.1765, 0.5763}, {0, 0.6523, 1.034, 1.186, 1.186, 1.186}},  // agreement
    {{0.1778, 0.3825, 0.4849, 0.5689, 0.6868, 0.9143}, {0, 0.2861, 0.5793, 0.6658, 0.6658, 0.6658}},  // low_presence
    {{-3.696, -1.332, -0.7633, -0.5176, -0.3469, -0.1303}, {0, -1.59, -2.021, -2.322, -2.678, -3.146}},  // low_conflict
    {{-4.913, -2.016, -1.161, -0.7725, -0.5085, -0.1923}, {0, -1.8, -2.102, -2.121, -2.301, -2.683}},  // low_clash
    {{0.1591, 0.3443, 0.4543, 0.5289, 0.6428, 0.8793}, {0, 0, 0, 0, 0, 0}},  // tall_presence
    {{-4.466, -1.872, -0.963, -0.6442, -0.4294, -0.1727}, {0, -0.9497, -0.9497, -0.9497, -0.9497, -0.9497}},  // tall_conflict
    {{-6.221, -2.452, -1.513, -0.9824, -0.6286, -0.2517}, {0, -3.409, -4.705, -5.322, -5.764, -6.084}},  // tall_clash
    {{0.0834, 0.2022, 0.2766, 0.3541, 0.4789, 0.84}, {0, 0, 0, 0, 0.05728, 0.05728}},  // explained
    {{0.3965, 0.5, 0.6859, 0.8132, 0.884, 0.9663}, {0, 0.2211, 0.2211, 0.2211, 0.2211, 0.2211}},  // normals
    {{0.4348, 0.5179, 0.5721, 0.6399, 0.7226, 0.8954}, {0, 0, 0, 0, 0, 0}},  // tightness
    {{0, 0.06293, 0.07206, 0.08077, 0.09371, 0.1339}, {0, -1.92, -1.92, -1.92, -1.92, -2.127}},  // residual
    {{5.806, 7.294, 8.498, 9.948, 13.5, 60}, {0, 0.2322, 0.5686, 1.115, 2.014, 2.014}},  // peak
    {{0.09131, 0.1564, 0.2286, 0.3652, 0.7652, 1}, {0, 0.2557, 0.6188, 1.361, 2.889, 4.928}},  // lead
    {{0, 4.977, 5.624, 6.014, 6.489, 7.738}, {0, 0, 0, 0, 0, 0}},  // support
    {{0, 3.466, 4.595, 5.333, 5.914, 7.237}, {0, 0, 0, 0, 0, 0}},  // tall_support
    {{0, 1.504, 2.015, 2.303, 2.603, 3.555}, {0, 0, 0, 0, 0, 0}},  // spread
    {{0, 0.06811, 0.1117, 0.161, 0.2197, 0.2967}, {0, 0, 0, 0, 0, 0}},  // constraint
    {{0, 3.611, 4.949, 5.525, 6.004, 6.567}, {0, 1.562, 2.771, 3.186, 3.186, 3.186}},  // ground
    {{0.02979, 0.05947, 0.07892, 0.09382, 0.1046, 0.1332}, {0, -0.3429, -0.5935, -0.5935, -0.5935, -0.5935}},  // ground_gap
    {{2.276e-05, 0.01384, 0.06623, 0.1417, 0.271, 0.8608}, {0, -0, -0, -0.1646, -1.062, -4.526}},  // near
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

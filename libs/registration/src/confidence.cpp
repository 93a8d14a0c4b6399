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
constexpr double kBias = -2.593;
constexpr std::array<Worth, kFeatures> kWorth = {{
    {{0, 0.02904, 0.069, 0.122, 0.202, 0.26, 0.3463, 0.6211}, {0, 0.5941, 1.178, 1.868, 2.392, 2.392, 2.392, 2.392}},  // agreement
    {{-4.476, -3.438, -2.967, -2.48, -1.778, -1.29, -0.9067, -0.4361}, {0, -0.06, -0.4703, -0.7569, -1.699, -2.765, -3.329, -3.71}},  // low_absence
    {{-7.15, -6.104, -5.325, -4.511, -1.771, -0.8538, -0.4578, -0.1291}, {0, -0.2246, -0.8416, -1.385, -1.522, -1.522, -1.581, -1.634}},  // tall_clash
    {{-6.103, -3.9, -2.89, -2.083, -1.059, -0.5872, -0.3506, -0.1423}, {0, -0.06404, -0.4581, -1.179, -1.67, -1.67, -1.67, -1.67}},  // object_clash
    {{-5.579, -3.738, -2.907, -2.303, -0.8996, -0.3469, -0.192, -0.07933}, {0, -0.7857, -1.629, -2.291, -2.637, -2.637, -2.637, -2.637}},  // far_conflict
    {{0, 1e-06, 1.099, 1.609, 2.89, 3.664, 3.951, 4.369}, {0, -0.213, -0.4908, -1.098, -2.249, -2.98, -3.272, -3.476}},  // contradicted
    {{0, 1e-06, 2e-06, 3e-06, 0.6932, 2.079, 3.045, 3.638}, {0, -0.2926, -0.5969, -0.9292, -1.321, -1.834, -2.074, -2.268}},  // tall_contradicted
    {{0, 0.05185, 0.06105, 0.06925, 0.07893, 0.08621, 0.09612, 0.1447}, {0, -1.93, -2.755, -2.843, -2.843, -2.843, -2.843, -2.929}},  // residual
    {{0, 1.792, 2.639, 3.367, 4.143, 4.913, 5.861, 6.779}, {0, 2.439, 3.36, 3.36, 3.36, 3.36, 3.642, 3.642}},  // objects
    {{0, 2.89, 4.111, 4.949, 5.663, 6.225, 6.653, 7.493}, {0, 0.08822, 0.2638, 0.9943, 1.516, 1.516, 1.516, 1.516}},  // tall_support
    {{0, 1.792, 2.833, 3.738, 4.868, 5.493, 5.986, 6.904}, {0, 0.4536, 0.8787, 0.8787, 0.8787, 0.8787, 0.8787, 0.8787}},  // far_support
    {{-5.375, -2.812, -1.125, 1.125, 4.5, 7.75, 11.13, 19.16}, {0, 0, 0.08287, 0.6831, 1.056, 1.056, 1.056, 1.056}},  // landmarks
    {{0, 1e-06, 7.934, 10.82, 22.27, 31.3, 40.88, 60}, {0, 0, 0, 0.3764, 1.242, 1.242, 1.242, 1.242}},  // peak
    {{0, 1e-06, 0.2399, 0.4999, 1, 1, 1, 1}, {0, 0, 0.3942, 2.046, 4.124, 5.19, 5.773, 6.161}},  // lead
    {{0, 3.584, 4.304, 4.812, 5.313, 5.694, 6.035, 6.567}, {0, 1.271, 2.024, 2.572, 2.572, 2.572, 2.572, 2.572}},  // ground
    {{0.01774, 0.03813, 0.05199, 0.06818, 0.08874, 0.1019, 0.1163, 0.1394}, {0, -0.9497, -1.257, -1.29, -1.669, -1.669, -1.669, -1.669}},  // ground_gap
    {{4.214e-05, 0.006517, 0.01622, 0.03768, 0.08451, 0.1473, 0.2838, 0.9396}, {0, -0, -0, -0.1604, -0.5964, -1.213, -2.823, -6.548}},  // near
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

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
constexpr double kBias = -1.044;
constexpr std::array<Worth, kFeatures> kWorth = {{
    {{0.00025, 0.03074, 0.06781, 0.1215, 0.2008, 0.2588, 0.3468, 0.621}, {0, 0.6771, 1.343, 2.15, 2.826, 2.826, 2.826, 2.826}},  // agreement
    {{-4.531, -3.454, -2.976, -2.489, -1.792, -1.293, -0.9031, -0.4473}, {0, -0.04275, -0.436, -0.9136, -2.332, -3.682, -4.405, -4.891}},  // low_absence
    {{-7.114, -6.115, -5.324, -4.522, -1.711, -0.821, -0.4464, -0.1289}, {0, -0.1353, -0.6314, -1.219, -1.547, -1.547, -1.547, -1.548}},  // tall_clash
    {{-6.117, -3.916, -2.897, -2.086, -1.042, -0.5839, -0.3536, -0.1498}, {0, -0.0786, -0.3474, -1.054, -1.539, -1.539, -1.539, -1.539}},  // object_clash
    {{-5.634, -3.731, -2.936, -2.303, -0.8994, -0.3472, -0.1934, -0.08062}, {0, -0.8498, -1.757, -2.407, -2.908, -2.978, -2.978, -2.978}},  // far_conflict
    {{0, 1e-06, 1.099, 1.609, 2.944, 3.664, 3.951, 4.369}, {0, -0.05814, -0.3002, -1.032, -2.168, -3.106, -3.631, -3.987}},  // contradicted
    {{0, 1e-06, 2e-06, 3e-06, 0.6932, 2.197, 3.045, 3.638}, {0, -0.2666, -0.5574, -0.9082, -1.384, -2.117, -2.576, -2.89}},  // tall_contradicted
    {{0, 0.05219, 0.06132, 0.06957, 0.07929, 0.08654, 0.09612, 0.1398}, {0, -2.123, -3.298, -3.604, -3.604, -3.604, -3.659, -3.766}},  // residual
    {{0, 1.792, 2.708, 3.367, 4.143, 4.898, 5.852, 6.776}, {0, 2.013, 2.71, 2.71, 2.71, 2.71, 2.787, 2.787}},  // objects
    {{0, 2.944, 4.159, 4.949, 5.652, 6.227, 6.646, 7.491}, {0, 0.1168, 0.2254, 0.7935, 1.169, 1.169, 1.169, 1.169}},  // tall_support
    {{0, 1.792, 2.773, 3.738, 4.875, 5.497, 5.981, 6.894}, {0, 0.3141, 0.6301, 0.6301, 0.6301, 0.6301, 0.6301, 0.6301}},  // far_support
    {{-5.375, -2.875, -1.187, 1.125, 4.5, 7.75, 11.13, 19.5}, {0, 0, 0.05713, 0.5636, 0.8996, 0.8996, 0.8996, 0.8996}},  // landmarks
    {{0, 1e-06, 7.833, 10.71, 22.37, 31.26, 40.88, 60}, {0, 0, 0, 0.6607, 2.203, 2.45, 2.45, 2.45}},  // peak
    {{-1, -1, -0.1306, 0.02073, 0.8011, 1.168, 1.467, 1.96}, {0, 0, 0.04047, 0.9905, 2.655, 2.655, 2.655, 2.655}},  // rise
    {{0, 3.611, 4.317, 4.804, 5.283, 5.663, 6.001, 6.561}, {0, 1.233, 2.146, 2.825, 2.945, 2.945, 2.945, 2.945}},  // ground
    {{0.01789, 0.03813, 0.05227, 0.06837, 0.08916, 0.1029, 0.1174, 0.1403}, {0, -0.8135, -1.142, -1.142, -1.446, -1.446, -1.446, -1.446}},  // ground_gap
    {{7.17e-05, 0.006873, 0.01732, 0.03834, 0.08297, 0.1414, 0.2755, 0.9353}, {0, -0, -0, -0.09306, -0.6385, -1.5, -3.319, -7.087}},  // near
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

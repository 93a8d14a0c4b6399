// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "loopmark/bev/correlation.hpp"
#include "loopmark/core/options.hpp"
#include "loopmark/estimation/planar_motions.hpp"
#include "loopmark/matching/filters.hpp"

namespace loopmark::registration {

/// Where hypotheses come from: the paper's way over matched descriptors, the correlation of the bird's-eye views,
/// things that stand alone.
constexpr const char* kFeatures = "features";
constexpr const char* kBev = "bev";
constexpr const char* kLandmarks = "landmarks";

/// From matched descriptors (Fourier shape contexts) to motions.
struct FeatureSourceOptions {
  matching::GpfOptions gpf;
  estimation::PlanarMotionOptions motions;
};

template <class Visitor>
void describe(Visitor& v, FeatureSourceOptions& o) {
  v.section("gpf", o.gpf, "Grid-Prioritized Filtering of the matches");
  v.section("motions", o.motions, "RANSAC with minimal sets of two matches");
}

/// Options of the registration engine; the defaults are meant for every sensor and scene.
struct EngineOptions {
  double min_p_correct = 0.5;                             ///< answers below this probability are withheld
  std::vector<std::string> sources = {kBev, kLandmarks};  ///< of hypotheses
  std::size_t landmarks = 16;                             ///< hypotheses of landmarks (0: none)
  std::size_t candidates = 64;                            ///< hypotheses that are looked at quickly
  std::size_t hypotheses = 10;                            ///< the best of these are refined and verified
  FeatureSourceOptions features;                          ///< of the matched descriptors
  bev::CorrelationOptions correlation;                    ///< of the bird's-eye views
};

/// Whether the source takes part.
bool asks(const EngineOptions& options, const std::string& source);

template <class Visitor>
void describe(Visitor& v, EngineOptions& o) {
  v.field("min_p_correct", o.min_p_correct, "answers below this probability are withheld");
  v.field("sources", o.sources,
          "where hypotheses come from: features (matched descriptors, GPF, RANSAC), bev (correlation of bird's-eye "
          "views), landmarks");
  v.field("landmarks", o.landmarks, "hypotheses of landmarks (0: none)");
  v.field("candidates", o.candidates, "hypotheses that are looked at quickly");
  v.field("hypotheses", o.hypotheses, "the best of these are refined and verified");
  v.section("features", o.features, "from matched descriptors to hypotheses");
  v.section("correlation", o.correlation, "search for hypotheses in the bird's-eye view");
}

/// Throws InputError when a source is unknown, or none is named.
void check(const EngineOptions& options);

}  // namespace loopmark::registration

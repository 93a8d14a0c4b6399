// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/feature_registration/named_algorithms.hpp"

#include <algorithm>

namespace loopmark::feature_registration {
namespace {

/// RANSAC (mutual) of the paper: PROSAC, edge-length check, local optimisation; 1 M iterations, confidence 0.9995.
FeatureRegistrationOptions mutual() {
  FeatureRegistrationOptions o;
  o.filter = MatchFilter::kMutual;
  o.ransac.confidence = 0.9995;
  o.ransac.max_iterations = 1'000'000;
  return o;
}

FeatureRegistrationOptions roles(estimation::Sampler sampler, estimation::Rejection rejection,
                                 estimation::LocalOptimization local) {
  FeatureRegistrationOptions o = mutual();
  o.ransac.sampler = sampler;
  o.ransac.rejection = rejection;
  o.ransac.local = local;
  return o;
}

/// RANSAC (GPF(phi)); the paper's cross-domain setting: 50 k iterations, confidence 0.999.
FeatureRegistrationOptions gpf(double phi, std::size_t iterations = 50'000) {
  FeatureRegistrationOptions o;
  o.filter = MatchFilter::kGpf;
  o.gpf.phi = phi;
  o.ransac.confidence = 0.999;
  o.ransac.max_iterations = iterations;
  return o;
}

FeatureRegistrationOptions gnc(estimation::Pruning pruning) {
  FeatureRegistrationOptions o = mutual();
  o.estimator = Estimator::kGnc;
  o.gnc.pruning = pruning;
  return o;
}

FeatureRegistrationOptions sc2() {
  FeatureRegistrationOptions o = mutual();
  o.estimator = Estimator::kSpatialConsistency;
  return o;
}

/// Of FPFH only: the other descriptors leave the ground out by themselves.
FeatureRegistrationOptions without_ground(FeatureRegistrationOptions o) {
  o.descriptor = "fpfh";
  o.match_ground = false;
  return o;
}

std::vector<NamedAlgorithm> make_table() {
  constexpr auto kProsac = estimation::Sampler::kProsac;
  constexpr auto kUniform = estimation::Sampler::kUniform;
  constexpr auto kElc = estimation::Rejection::kEdgeLength;
  constexpr auto kLo = estimation::LocalOptimization::kInner;
  return {
      {"ransac_gpf", "RANSAC (GPF(2)) of the paper", "phi", gpf(2.0)},
      {"ransac_mutual", "RANSAC (mutual) of the paper: PROSAC, ELC, LO", "roles", mutual()},
      {"gnc_clique", "GNC-TLS after a large clique (TEASER++ family)", "", gnc(estimation::Pruning::kClique)},
      {"gnc_core", "GNC-TLS after the maximum k-core (KISS-Matcher family)", "",
       gnc(estimation::Pruning::kMaximumCore)},
      {"sc2", "second-order spatial consistency (PointDSC without what is learned)", "", sc2()},
      {"ransac_gpf_no_ground", "RANSAC (GPF(2)) on FPFH, ground left out of the matching", "",
       without_ground(gpf(2.0))},
      {"ransac_mutual_no_ground", "RANSAC (mutual) on FPFH, ground left out", "", without_ground(mutual())},
      {"gnc_clique_no_ground", "GNC-TLS after a clique on FPFH, ground left out", "",
       without_ground(gnc(estimation::Pruning::kClique))},
      {"sc2_no_ground", "spatial consistency on FPFH, ground left out", "", without_ground(sc2())},
      {"ransac_uniform", "uniform sampling, ELC, LO", "roles", roles(kUniform, kElc, kLo)},
      {"ransac_sprt", "PROSAC, SPRT, LO", "roles", roles(kProsac, estimation::Rejection::kSprt, kLo)},
      {"ransac_uniform_sprt", "uniform sampling, SPRT, LO", "roles",
       roles(kUniform, estimation::Rejection::kSprt, kLo)},
      {"ransac_no_rejection", "PROSAC, no early rejection, LO", "roles",
       roles(kProsac, estimation::Rejection::kNone, kLo)},
      {"gcransac", "PROSAC, ELC, graph cut", "local", roles(kProsac, kElc, estimation::LocalOptimization::kGraphCut)},
      {"ransac_no_lo", "PROSAC, ELC, no local optimisation", "local",
       roles(kProsac, kElc, estimation::LocalOptimization::kNone)},
      {"ransac_gpf3_1m", "RANSAC (GPF(3)), 1 M iterations, as in the paper's same-domain table", "",
       gpf(3.0, 1'000'000)},
      {"ransac_gpf1", "GPF(1)", "phi", gpf(1.0)},
      {"ransac_gpf3", "GPF(3)", "phi", gpf(3.0)},
      {"ransac_gpf_10k", "GPF(2), 10 k iterations", "iterations", gpf(2.0, 10'000)},
      {"ransac_gpf_200k", "GPF(2), 200 k iterations", "iterations", gpf(2.0, 200'000)},
      {"ransac_gpf_1m", "GPF(2), 1 M iterations", "iterations", gpf(2.0, 1'000'000)},
  };
}

}  // namespace

const std::vector<NamedAlgorithm>& named_algorithms() {
  static const std::vector<NamedAlgorithm> table = make_table();
  return table;
}

const FeatureRegistrationOptions& named_algorithm(const std::string& name) {
  const auto& table = named_algorithms();
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.name == name; });
  if (found != table.end()) {
    return found->options;
  }
  std::string names;
  for (const NamedAlgorithm& entry : table) {
    names += (names.empty() ? "" : ", ") + entry.name;
  }
  throw InputError("no algorithm is called '" + name + "' (there are: " + names + ")");
}

}  // namespace loopmark::feature_registration

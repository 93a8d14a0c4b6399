// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "loopmark/core/options.hpp"
#include "loopmark/least_squares/robust_kernel.hpp"

namespace loopmark::refinement {

/// What is minimised between paired points (paper, appendix "Local Registration").
enum class IcpMetric {
  kPointToPoint,  ///< Besl and McKay 1992; the paper's choice
  kPointToPlane,  ///< Chen and Medioni 1992: normals of the target
  kSymmetric,     ///< Rusinkiewicz 2019: normals of both
  kGeneralized,   ///< Segal et al. 2009: plane-to-plane, covariances from the normals of both
};

/// How points are paired.
enum class IcpPairing {
  kNearest,      ///< the nearest target point within max_distance_m
  kBestBuddies,  ///< only mutual nearest neighbours (Best-Buddies Registration, Drory et al. 2020)
};

/// Local refinement of a motion; the defaults are the paper's (Sec. 5 and appendix).
struct IcpOptions {
  IcpMetric metric = IcpMetric::kPointToPoint;
  IcpPairing pairing = IcpPairing::kNearest;
  least_squares::RobustKernel kernel = least_squares::RobustKernel::kNone;
  double kernel_scale_m = 0.2;
  double max_distance_m = 0.6;
  std::size_t max_iterations = 30;
  double stop_translation_m = 1e-3;
  double stop_rotation_deg = 0.005;
  std::size_t min_pairs = 20;
  double weak_strength = 0.01;
  double noise_floor_m = 0.01;
};

template <class Visitor>
void describe(Visitor& v, IcpOptions& o) {
  v.choice("metric", o.metric,
           {{"point_to_point", IcpMetric::kPointToPoint},
            {"point_to_plane", IcpMetric::kPointToPlane},
            {"symmetric", IcpMetric::kSymmetric},
            {"generalized", IcpMetric::kGeneralized}},
           "what is minimised between paired points");
  v.choice("pairing", o.pairing, {{"nearest", IcpPairing::kNearest}, {"best_buddies", IcpPairing::kBestBuddies}},
           "nearest target point, or mutual nearest neighbours only");
  v.choice("kernel", o.kernel,
           {{"none", least_squares::RobustKernel::kNone},
            {"huber", least_squares::RobustKernel::kHuber},
            {"cauchy", least_squares::RobustKernel::kCauchy},
            {"geman_mcclure", least_squares::RobustKernel::kGemanMcClure},
            {"tukey", least_squares::RobustKernel::kTukey},
            {"truncated", least_squares::RobustKernel::kTruncated}},
           "robust kernel on the residuals");
  v.field("kernel_scale_m", o.kernel_scale_m, "scale of the robust kernel, metres");
  v.field("max_distance_m", o.max_distance_m, "pairs further apart are left out, metres");
  v.field("max_iterations", o.max_iterations, "iterations at most");
  v.field("stop_translation_m", o.stop_translation_m, "converged when a step moves less than this, metres");
  v.field("stop_rotation_deg", o.stop_rotation_deg, "and turns less than this, degrees");
  v.field("min_pairs", o.min_pairs, "fewer pairs: stop");
  v.field("weak_strength", o.weak_strength, "directions with less constraint than this (0 to 1) count as weak");
  v.field("noise_floor_m", o.noise_floor_m, "residuals are never believed to be better than this, metres");
}

inline void check(const IcpOptions& o) {
  require_option(o.kernel_scale_m > 0, "kernel_scale_m", "must be larger than 0");
  require_option(o.max_distance_m > 0, "max_distance_m", "must be larger than 0");
  require_option(o.noise_floor_m > 0, "noise_floor_m", "must be larger than 0");
}

}  // namespace loopmark::refinement

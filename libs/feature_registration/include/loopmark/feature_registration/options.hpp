// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "loopmark/core/options.hpp"
#include "loopmark/estimation/gnc.hpp"
#include "loopmark/estimation/ransac.hpp"
#include "loopmark/estimation/spatial_consistency.hpp"
#include "loopmark/features/fpfh.hpp"
#include "loopmark/features/ground.hpp"
#include "loopmark/features/normals.hpp"
#include "loopmark/matching/filters.hpp"
#include "loopmark/refinement/icp_options.hpp"
#include "loopmark/shape_context/options.hpp"

namespace loopmark::feature_registration {

/// What is kept of a voxel.
enum class VoxelPoint { kFirst, kCentroid };

/// Which matches go to the estimator (paper, Sec. 4).
enum class MatchFilter { kAll, kMutual, kGpf };

/// Which estimator finds the motion (paper, Sec. 5).
enum class Estimator { kRansac, kGnc, kSpatialConsistency };

/// The paper's pipeline, every step a choice; the defaults are RANSAC (GPF).
struct FeatureRegistrationOptions {
  double voxel_m = 0.3;
  VoxelPoint voxel_point = VoxelPoint::kFirst;
  std::string descriptor = "fsc";  ///< one of descriptors()
  shape_context::Options fsc;
  features::NormalOptions normals;
  features::FpfhOptions fpfh;
  bool match_ground = true;
  features::GroundOptions ground;
  MatchFilter filter = MatchFilter::kGpf;
  matching::GpfOptions gpf;
  double max_ratio = 1.0;
  std::size_t max_matches = 0;
  Estimator estimator = Estimator::kRansac;
  estimation::RansacOptions ransac;
  estimation::GncOptions gnc;
  estimation::SpatialConsistencyOptions spatial_consistency;
  bool refine = true;
  refinement::IcpOptions icp;
};

template <class Visitor>
void describe(Visitor& v, FeatureRegistrationOptions& o) {
  v.field("voxel_m", o.voxel_m, "edge of a voxel of the downsampling, metres");
  v.choice("voxel_point", o.voxel_point, {{"first", VoxelPoint::kFirst}, {"centroid", VoxelPoint::kCentroid}},
           "what is kept of a voxel: one original point, or the centroid");
  v.field("descriptor", o.descriptor, "local descriptors: fsc (Fourier shape context) or fpfh");
  v.section("fsc", o.fsc, "Fourier shape context");
  v.section("normals", o.normals, "surface normals");
  v.section("fpfh", o.fpfh, "Fast Point Feature Histograms");
  v.field("match_ground", o.match_ground, "fpfh: match ground points too, as the paper does");
  v.section("ground", o.ground, "which points are left out where match_ground is false");
  v.choice("filter", o.filter,
           {{"all", MatchFilter::kAll}, {"mutual", MatchFilter::kMutual}, {"gpf", MatchFilter::kGpf}},
           "which matches go to the estimator");
  v.section("gpf", o.gpf, "Grid-Prioritized Filtering");
  v.field("max_ratio", o.max_ratio, "matches with a higher ratio of first to second distance are left out; 1: none");
  v.field("max_matches", o.max_matches, "no more than this many of the best matches are used; 0: all");
  v.choice("estimator", o.estimator,
           {{"ransac", Estimator::kRansac},
            {"gnc", Estimator::kGnc},
            {"spatial_consistency", Estimator::kSpatialConsistency}},
           "which estimator finds the motion");
  v.section("ransac", o.ransac, "RANSAC");
  v.section("gnc", o.gnc, "graduated non-convexity after pruning");
  v.section("spatial_consistency", o.spatial_consistency, "second-order spatial consistency");
  v.field("refine", o.refine, "refine the motion by ICP");
  v.section("icp", o.icp, "refinement");
}

inline void check(const FeatureRegistrationOptions& o) {
  require_option(o.voxel_m > 0, "voxel_m", "must be larger than 0");
  require_option(o.max_ratio > 0, "max_ratio", "must be larger than 0");
  check(o.fsc);
  check(o.normals);
  check(o.fpfh);
  check(o.ground);
  check(o.gpf);
  check(o.ransac);
  check(o.gnc);
  check(o.spatial_consistency);
  check(o.icp);
}

}  // namespace loopmark::feature_registration

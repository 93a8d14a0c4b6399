// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The registration pipeline of Drory, Giryes and Avidan, "Stress-Testing Point Cloud Registration on Automotive LiDAR"
/// (2022): descriptors, matches, filtering, robust estimation, refinement.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/estimation/estimate.hpp"
#include "loopmark/feature_registration/options.hpp"
#include "loopmark/refinement/icp.hpp"
#include "loopmark/registration/engine.hpp"
#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::feature_registration {

/// A scan made ready for matching.
struct DescribedScan {
  refinement::Surface surface;             ///< downsampled points, and normals where they were computed
  std::vector<Eigen::Vector3f> keypoints;  ///< the points that have a descriptor, one a row
  search::DescriptorRows descriptors;
  std::vector<registration::StageTime> timings;  ///< "downsample", "normals", "descriptors"
};

/// Downsampling, normals where they are needed and the descriptors of options.descriptor for one scan (points in the
/// sensor's frame, metres).
DescribedScan describe_scan(const PointCloud& cloud, const FeatureRegistrationOptions& options);

/// A scan whose descriptors come from elsewhere (learned ones, read from a file); `keypoints` has one point a row. The
/// cloud, downsampled, serves the refinement; empty: the keypoints do.
DescribedScan described_scan(std::vector<Eigen::Vector3f> keypoints, search::DescriptorRows descriptors,
                             const PointCloud& cloud, const FeatureRegistrationOptions& options);

/// What the pipeline found, with what happened on the way.
struct FeatureRegistrationResult {
  Pose T_target_source = Pose::Identity();  ///< after refinement, where it is on
  Pose T_coarse = Pose::Identity();         ///< of the estimator
  bool found = false;
  estimation::Estimate estimate;
  refinement::IcpResult refinement;
  std::size_t matches = 0;  ///< one a source keypoint
  std::size_t mutual_matches = 0;
  std::size_t used_matches = 0;                  ///< after filtering
  matching::Correspondences used;                ///< these, in the order of quality
  std::vector<registration::StageTime> timings;  ///< "nearest", "filter", "estimate", "refine"

  /// The paper's accounting ("Algo. only"): filtering and estimation. Downsampling, descriptors and the search for
  /// neighbours are left out; of the latter the paper counts the second neighbour, which is found here
  /// in one pass with the first.
  double algorithm_seconds() const;
  /// The same with refinement ("with ICP").
  double with_refinement_seconds() const;
  /// Everything in `timings`; after register_described add those of the two described scans.
  double all_seconds() const;
};

/// What the estimators of a pair start from; variants that describe scans alike share it.
struct ScanMatches {
  matching::Correspondences all;  ///< of each source keypoint the nearest target keypoint in feature space
  std::size_t mutual = 0;
  std::vector<registration::StageTime> timings;  ///< "nearest"
};

/// Throws InputError naming both origins (files, or what else the scans are called) when the descriptors of two scans
/// cannot be compared: other lengths, or quantised ones and others.
void require_comparable(const DescribedScan& source, const std::string& source_origin, const DescribedScan& target,
                        const std::string& target_origin);

/// Sec. 4 of the paper: every source point is matched to the target point nearest to it in feature space.
ScanMatches match_described(const DescribedScan& source, const DescribedScan& target);

/// Finds T_target_source from the matches of two described scans; the timings start with those of the matches.
FeatureRegistrationResult register_matched(const DescribedScan& source, const DescribedScan& target,
                                           const ScanMatches& matches, const FeatureRegistrationOptions& options);

/// Finds T_target_source from the descriptors of two scans.
FeatureRegistrationResult register_described(const DescribedScan& source, const DescribedScan& target,
                                             const FeatureRegistrationOptions& options);

/// The whole pipeline on two raw scans; the timings start with those of both scans.
FeatureRegistrationResult register_features(const PointCloud& source, const PointCloud& target,
                                            const FeatureRegistrationOptions& options);

}  // namespace loopmark::feature_registration

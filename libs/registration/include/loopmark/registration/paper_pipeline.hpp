// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The registration pipeline of Drory, Giryes and Avidan, "Stress-Testing Point Cloud Registration on Automotive LiDAR"
/// (2022): descriptors, matches, filtering, robust estimation, refinement.
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/estimation/estimate.hpp"
#include "loopmark/refinement/icp.hpp"
#include "loopmark/registration/engine.hpp"
#include "loopmark/registration/paper_options.hpp"
#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark {

/// A scan made ready for matching.
struct DescribedScan {
  Surface surface;                         ///< downsampled points, and normals where they were computed
  std::vector<Eigen::Vector3f> keypoints;  ///< the points that have a descriptor, one a row
  DescriptorMatrix descriptors;
  std::vector<StageTime> timings;  ///< "downsample", "normals", "descriptors"
};

/// Downsampling, normals and FPFH of one scan (points in the sensor's frame, metres).
DescribedScan describe_scan(const PointCloud& cloud, const PaperOptions& options);

/// A scan whose descriptors come from elsewhere (learned ones, read from a file); `keypoints` has one point a row. The
/// cloud, downsampled, serves the refinement; empty: the keypoints do.
DescribedScan described_scan(std::vector<Eigen::Vector3f> keypoints, DescriptorMatrix descriptors,
                             const PointCloud& cloud, const PaperOptions& options);

/// What the pipeline found, with what happened on the way.
struct PaperResult {
  Pose T_target_source = Pose::Identity();  ///< after refinement, where it is on
  Pose T_coarse = Pose::Identity();         ///< of the estimator
  bool found = false;
  Estimate estimate;
  IcpResult refinement;
  std::size_t matches = 0;  ///< one a source keypoint
  std::size_t mutual_matches = 0;
  std::size_t used_matches = 0;    ///< after filtering
  Correspondences used;            ///< these, in the order of quality
  std::vector<StageTime> timings;  ///< "nearest", "filter", "estimate", "refine"

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
  Correspondences all;  ///< of each source keypoint the nearest target keypoint in feature space
  std::size_t mutual = 0;
  std::vector<StageTime> timings;  ///< "nearest"
};

/// Sec. 4 of the paper: every source point is matched to the target point nearest to it in feature space.
ScanMatches match_described(const DescribedScan& source, const DescribedScan& target);

/// Finds T_target_source from the matches of two described scans; the timings start with those of the matches.
PaperResult register_matched(const DescribedScan& source, const DescribedScan& target, const ScanMatches& matches,
                             const PaperOptions& options);

/// Finds T_target_source from the descriptors of two scans.
PaperResult register_described(const DescribedScan& source, const DescribedScan& target, const PaperOptions& options);

/// The whole pipeline on two raw scans; the timings start with those of both scans.
PaperResult register_like_the_paper(const PointCloud& source, const PointCloud& target, const PaperOptions& options);

}  // namespace loopmark

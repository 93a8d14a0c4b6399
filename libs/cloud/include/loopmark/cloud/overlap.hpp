// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The paper's overlap of two scans (Sec. 3, and the generator of the balanced sets).
#pragma once

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/search/kd_tree.hpp"

namespace loopmark::cloud {

struct Overlap {
  double source = 0.0;     ///< n / |A|: the share of the source that the target has seen
  double symmetric = 0.0;  ///< min(n / |A|, n / |B|), same n
};

/// A scan made ready for overlap: centroids of 1 m voxels and their tree.
class OverlapCloud {
 public:
  explicit OverlapCloud(const std::vector<Eigen::Vector3f>& points);
  const search::KdTree& tree() const { return tree_; }

 private:
  search::KdTree tree_;
};

/// Moves the source by the truth and counts the n source centroids that have a target centroid nearer than sqrt(2) m.
/// The source is reduced to 1 m centroids in its own frame before it is moved.
Overlap overlap(const OverlapCloud& source, const OverlapCloud& target, const Pose& T_target_source);

/// The definition to the letter: the source is moved first, then both are reduced to centroids of 1 m voxels.
Overlap overlap(const PointCloud& source, const PointCloud& target, const Pose& T_target_source);

}  // namespace loopmark::cloud

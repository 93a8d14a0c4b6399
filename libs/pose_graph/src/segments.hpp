// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Segments: the parts of a graph that trusted odometry connects.
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::pose_graph::internal {

struct Segments {
  std::vector<std::size_t> segment_of;          ///< for each node
  std::vector<std::vector<std::size_t>> nodes;  ///< of each segment, increasing
  /// Poses chained along odometry from the initial pose of the segment's first node.
  std::vector<Pose> T_segment_node;
  /// First-order covariance of exp(xi) * T_segment_node, xi in the frame of the segment.
  std::vector<Matrix6d> covariance;

  /// Covariance of the chained motion between two nodes of one segment, in the frame of the segment. Exact
  /// where one lies on the way to the other, else an upper bound.
  Matrix6d covariance_between(std::size_t a, std::size_t b) const;

  std::vector<std::size_t> entered, left;  ///< depth-first numbering of the spanning tree
};

Segments find_segments(const PoseGraph& graph);

/// A symmetric 6x6 matrix inverted; directions without information get a variance of 1e6 at most.
Matrix6d invert_information(const Matrix6d& information);

}  // namespace loopmark::pose_graph::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Pairwise consistency maximisation (Mangelson et al., "Pairwise Consistent Measurement Set Maximization", ICRA 2018).
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/pose_graph/pose_graph.hpp"
#include "segments.hpp"

namespace loopmark::pose_graph::internal {

/// The loops between the same two segments (or within one).
struct LoopGroup {
  std::size_t first_segment = 0;  ///< at most second_segment
  std::size_t second_segment = 0;
  std::vector<std::size_t> edges;  ///< indices into the graph's edges, loops and forced ones
  std::vector<std::size_t>
      agreeing;  ///< the largest set found whose members agree pairwise, and what agrees with most of it
  std::size_t representative = 0;  ///< the agreeing edge that agrees best with the others
};

std::vector<LoopGroup> group_loops(const PoseGraph& graph, const Segments& segments);

/// Chi-square (6 degrees of freedom) of the cycle that two loops of one group close over the odometry of
/// their segments: small when they tell the same story.
double cycle_chi2(const PoseGraph& graph, const Segments& segments, std::size_t edge_a, std::size_t edge_b);

/// Fills `agreeing` and `representative` of each group, and the reports of its edges: those left out get the
/// verdict kInconsistent and weight 0. Forced edges always stay, and whatever contradicts one goes.
void keep_consistent(const PoseGraph& graph, const Segments& segments, const PoseGraphOptions& options,
                     std::vector<LoopGroup>& groups, std::vector<EdgeReport>& reports);

}  // namespace loopmark::pose_graph::internal

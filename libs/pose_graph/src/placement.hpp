// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Where segments stand relative to one another.
#pragma once

#include <cstddef>
#include <vector>

#include "consistency.hpp"
#include "loopmark/pose_graph/pose_graph.hpp"
#include "segments.hpp"

namespace loopmark::pose_graph::internal {

/// For each segment the set of segments it is joined with by at least `min_links` believed loops (weight > 0.5, or one
/// forced) between two of them; the smallest segment names the set.
std::vector<std::size_t> joined_sets(const PoseGraph& graph, const Segments& segments,
                                     const std::vector<LoopGroup>& groups, const std::vector<EdgeReport>& reports,
                                     std::size_t min_links);

/// Rejects (kTooFewLinks, weight 0) the believed loops between segments that joined_sets keeps apart.
/// Returns how many.
std::size_t reject_thin_links(const PoseGraph& graph, const Segments& segments, const std::vector<LoopGroup>& groups,
                              std::size_t min_links, std::vector<EdgeReport>& reports);

/// Initial poses of all nodes: within a segment chained odometry; a joined set in the frame of its anchored segment (of
/// its first one, if none is), placed by the best agreeing loop of each pair of segments, largest agreement first.
std::vector<Pose> placed_poses(const PoseGraph& graph, const Segments& segments, const std::vector<LoopGroup>& groups,
                               const std::vector<EdgeReport>& reports, std::size_t min_links);

}  // namespace loopmark::pose_graph::internal

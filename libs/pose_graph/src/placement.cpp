// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "placement.hpp"

#include <algorithm>

#include "disjoint_sets.hpp"

namespace loopmark::pose_graph::internal {
namespace {

std::size_t believed_links(const PoseGraph& graph, const LoopGroup& group, const std::vector<EdgeReport>& reports,
                           std::size_t min_links) {
  std::size_t links = 0;
  for (const std::size_t e : group.edges) {
    if (graph.edges[e].kind == EdgeKind::kForced) {
      return std::max(min_links, group.edges.size());
    }
    links += reports[e].weight > 0.5 ? 1 : 0;
  }
  return links;
}

DisjointSets join_segments(const PoseGraph& graph, const Segments& segments, const std::vector<LoopGroup>& groups,
                           const std::vector<EdgeReport>& reports, std::size_t min_links) {
  DisjointSets sets(segments.nodes.size());
  for (const LoopGroup& group : groups) {
    if (believed_links(graph, group, reports, min_links) >= min_links) {
      sets.join(group.first_segment, group.second_segment);
    }
  }
  return sets;
}

std::vector<bool> anchored_segments(const PoseGraph& graph, const Segments& segments) {
  std::vector<bool> anchored(segments.nodes.size(), false);
  for (const std::size_t node : graph.anchors) {
    anchored[segments.segment_of[node]] = true;
  }
  return anchored;
}

/// Groups that join two segments, those with most believed links first.
std::vector<const LoopGroup*> strongest_first(const PoseGraph& graph, const std::vector<LoopGroup>& groups,
                                              const std::vector<EdgeReport>& reports, std::size_t min_links) {
  std::vector<std::pair<std::size_t, const LoopGroup*>> ranked;
  for (const LoopGroup& group : groups) {
    const std::size_t links = believed_links(graph, group, reports, min_links);
    if (group.first_segment != group.second_segment && links >= min_links) {
      ranked.emplace_back(links, &group);
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const LoopGroup*> order;
  for (const auto& [links, group] : ranked) {
    order.push_back(group);
  }
  return order;
}

}  // namespace

std::vector<std::size_t> joined_sets(const PoseGraph& graph, const Segments& segments,
                                     const std::vector<LoopGroup>& groups, const std::vector<EdgeReport>& reports,
                                     std::size_t min_links) {
  DisjointSets sets = join_segments(graph, segments, groups, reports, min_links);
  std::vector<std::size_t> set_of(segments.nodes.size());
  for (std::size_t p = 0; p < set_of.size(); ++p) {
    set_of[p] = sets.root(p);
  }
  return set_of;
}

std::size_t reject_thin_links(const PoseGraph& graph, const Segments& segments, const std::vector<LoopGroup>& groups,
                              std::size_t min_links, std::vector<EdgeReport>& reports) {
  const std::vector<std::size_t> set_of = joined_sets(graph, segments, groups, reports, min_links);
  std::size_t rejected = 0;
  for (const LoopGroup& group : groups) {
    if (set_of[group.first_segment] == set_of[group.second_segment]) {
      continue;
    }
    for (const std::size_t e : group.edges) {
      if (reports[e].verdict == EdgeVerdict::kAccepted) {
        reports[e].verdict = EdgeVerdict::kTooFewLinks;
        reports[e].weight = 0.0;
        ++rejected;
      }
    }
  }
  return rejected;
}

std::vector<Pose> placed_poses(const PoseGraph& graph, const Segments& segments, const std::vector<LoopGroup>& groups,
                               const std::vector<EdgeReport>& reports, std::size_t min_links) {
  std::vector<bool> anchored = anchored_segments(graph, segments);
  std::vector<Pose> T_map_segment(segments.nodes.size(), Pose::Identity());
  DisjointSets sets(segments.nodes.size());
  for (const LoopGroup* group : strongest_first(graph, groups, reports, min_links)) {
    const std::size_t a = sets.root(group->first_segment);
    const std::size_t b = sets.root(group->second_segment);
    if (a == b || (anchored[a] && anchored[b])) {
      continue;
    }
    const PoseGraphEdge& edge = graph.edges[group->representative];
    const Pose from =
        T_map_segment[segments.segment_of[edge.from]] * segments.T_segment_node[edge.from] * edge.T_from_to;
    const Pose to = T_map_segment[segments.segment_of[edge.to]] * segments.T_segment_node[edge.to];
    const std::size_t moving = anchored[b] || (!anchored[a] && b < a) ? a : b;
    const bool moves_to = sets.root(segments.segment_of[edge.to]) == moving;
    const Pose step = moves_to ? from * to.inverse() : to * from.inverse();
    for (std::size_t p = 0; p < T_map_segment.size(); ++p) {
      if (sets.root(p) == moving) {
        T_map_segment[p] = step * T_map_segment[p];
      }
    }
    sets.join(a, b);
    anchored[sets.root(a)] = anchored[a] || anchored[b];
  }
  std::vector<Pose> poses(graph.T_map_node.size());
  for (std::size_t node = 0; node < poses.size(); ++node) {
    poses[node] = T_map_segment[segments.segment_of[node]] * segments.T_segment_node[node];
  }
  for (const std::size_t node : graph.anchors) {
    poses[node] = graph.T_map_node[node];
  }
  return poses;
}

}  // namespace loopmark::pose_graph::internal

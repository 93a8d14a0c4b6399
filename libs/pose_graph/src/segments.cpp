// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "segments.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace loopmark::pose_graph::internal {
namespace {

struct Link {
  std::size_t neighbour = 0;
  std::size_t edge = 0;
};

std::vector<std::vector<Link>> odometry_links(const PoseGraph& graph) {
  std::vector<std::vector<Link>> links(graph.T_map_node.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const PoseGraphEdge& edge = graph.edges[e];
    if (edge.kind == EdgeKind::kOdometry) {
      links[edge.from].push_back({edge.to, e});
      links[edge.to].push_back({edge.from, e});
    }
  }
  for (std::vector<Link>& list : links) {
    std::stable_sort(list.begin(), list.end(), [](const Link& a, const Link& b) { return a.neighbour < b.neighbour; });
  }
  return links;
}

/// Chains `child` to `parent` along the edge: pose and covariance.
void chain(const PoseGraphEdge& edge, std::size_t parent, std::size_t child, Segments& segments) {
  const Pose& T_segment_parent = segments.T_segment_node[parent];
  const bool forward = edge.from == parent;
  segments.T_segment_node[child] = T_segment_parent * (forward ? edge.T_from_to : edge.T_from_to.inverse());
  // The tangent of the measurement lives in the frame of `from`.
  const Matrix6d to_segment = adjoint(forward ? T_segment_parent : segments.T_segment_node[child]);
  segments.covariance[child] =
      segments.covariance[parent] + to_segment * invert_information(edge.information) * to_segment.transpose();
}

constexpr std::size_t kUnseen = static_cast<std::size_t>(-1);

/// Depth first from `root`, smaller neighbours first: an odometry chain becomes a path even with skipping edges.
void walk(std::size_t root, const PoseGraph& graph, const std::vector<std::vector<Link>>& links, Segments& segments,
          std::size_t& clock) {
  struct Visit {
    std::size_t node;
    std::size_t next_link;
  };
  const std::size_t segment = segments.nodes.size();
  segments.nodes.emplace_back();
  std::vector<Visit> stack;
  const auto enter = [&](std::size_t node) {
    segments.segment_of[node] = segment;
    segments.nodes.back().push_back(node);
    segments.entered[node] = clock++;
    stack.push_back({node, 0});
  };
  segments.T_segment_node[root] = graph.T_map_node[root];
  enter(root);
  while (!stack.empty()) {
    const std::size_t node = stack.back().node;
    if (stack.back().next_link == links[node].size()) {
      segments.left[node] = clock++;
      stack.pop_back();
      continue;
    }
    const Link link = links[node][stack.back().next_link++];
    if (segments.segment_of[link.neighbour] == kUnseen) {
      chain(graph.edges[link.edge], node, link.neighbour, segments);
      enter(link.neighbour);
    }
  }
  std::sort(segments.nodes.back().begin(), segments.nodes.back().end());
}

}  // namespace

Matrix6d invert_information(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(1e-6).cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

Matrix6d Segments::covariance_between(std::size_t a, std::size_t b) const {
  if (entered[a] <= entered[b] && left[b] <= left[a]) {
    return covariance[b] - covariance[a];
  }
  if (entered[b] <= entered[a] && left[a] <= left[b]) {
    return covariance[a] - covariance[b];
  }
  return covariance[a] + covariance[b];
}

Segments find_segments(const PoseGraph& graph) {
  const std::size_t count = graph.T_map_node.size();
  Segments segments;
  segments.segment_of.assign(count, kUnseen);
  segments.T_segment_node.assign(count, Pose::Identity());
  segments.covariance.assign(count, Matrix6d::Zero());
  segments.entered.assign(count, 0);
  segments.left.assign(count, 0);
  const auto links = odometry_links(graph);
  std::size_t clock = 0;
  for (std::size_t node = 0; node < count; ++node) {
    if (segments.segment_of[node] == kUnseen) {
      walk(node, graph, links, segments, clock);
    }
  }
  return segments;
}

}  // namespace loopmark::pose_graph::internal

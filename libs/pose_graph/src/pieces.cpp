// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pieces.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace loopmark::pose_graph {
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
void chain(const PoseGraphEdge& edge, std::size_t parent, std::size_t child, Pieces& pieces) {
  const Pose& T_piece_parent = pieces.T_piece_node[parent];
  const bool forward = edge.from == parent;
  pieces.T_piece_node[child] = T_piece_parent * (forward ? edge.T_from_to : edge.T_from_to.inverse());
  // The tangent of the measurement lives in the frame of `from`.
  const Matrix6d to_piece = adjoint(forward ? T_piece_parent : pieces.T_piece_node[child]);
  pieces.covariance[child] =
      pieces.covariance[parent] + to_piece * invert_information(edge.information) * to_piece.transpose();
}

constexpr std::size_t kUnseen = static_cast<std::size_t>(-1);

/// Depth first from `root`, smaller neighbours first: an odometry chain becomes a path even with skipping edges.
void walk(std::size_t root, const PoseGraph& graph, const std::vector<std::vector<Link>>& links, Pieces& pieces,
          std::size_t& clock) {
  struct Visit {
    std::size_t node;
    std::size_t next_link;
  };
  const std::size_t piece = pieces.nodes.size();
  pieces.nodes.emplace_back();
  std::vector<Visit> stack;
  const auto enter = [&](std::size_t node) {
    pieces.piece_of[node] = piece;
    pieces.nodes.back().push_back(node);
    pieces.entered[node] = clock++;
    stack.push_back({node, 0});
  };
  pieces.T_piece_node[root] = graph.T_map_node[root];
  enter(root);
  while (!stack.empty()) {
    const std::size_t node = stack.back().node;
    if (stack.back().next_link == links[node].size()) {
      pieces.left[node] = clock++;
      stack.pop_back();
      continue;
    }
    const Link link = links[node][stack.back().next_link++];
    if (pieces.piece_of[link.neighbour] == kUnseen) {
      chain(graph.edges[link.edge], node, link.neighbour, pieces);
      enter(link.neighbour);
    }
  }
  std::sort(pieces.nodes.back().begin(), pieces.nodes.back().end());
}

}  // namespace

Matrix6d invert_information(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(1e-6).cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

Matrix6d Pieces::covariance_between(std::size_t a, std::size_t b) const {
  if (entered[a] <= entered[b] && left[b] <= left[a]) {
    return covariance[b] - covariance[a];
  }
  if (entered[b] <= entered[a] && left[a] <= left[b]) {
    return covariance[a] - covariance[b];
  }
  return covariance[a] + covariance[b];
}

Pieces find_pieces(const PoseGraph& graph) {
  const std::size_t count = graph.T_map_node.size();
  Pieces pieces;
  pieces.piece_of.assign(count, kUnseen);
  pieces.T_piece_node.assign(count, Pose::Identity());
  pieces.covariance.assign(count, Matrix6d::Zero());
  pieces.entered.assign(count, 0);
  pieces.left.assign(count, 0);
  const auto links = odometry_links(graph);
  std::size_t clock = 0;
  for (std::size_t node = 0; node < count; ++node) {
    if (pieces.piece_of[node] == kUnseen) {
      walk(node, graph, links, pieces, clock);
    }
  }
  return pieces;
}

}  // namespace loopmark::pose_graph

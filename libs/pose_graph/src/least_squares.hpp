// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One weighted solve on Ceres.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::pose_graph::internal {

/// Components of the nodes over edges of positive weight; anchored ones first, then by first node.
std::vector<PoseGraphComponent> find_components(const PoseGraph& graph, const std::vector<double>& weights);

/// True for nodes that do not move: anchors, and the first node of each component without one.
std::vector<bool> fixed_nodes(const PoseGraph& graph, const std::vector<PoseGraphComponent>& components);

struct SolveReport {
  bool converged = false;
  std::size_t iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  std::string message;
};

/// Levenberg-Marquardt on sum of weight * chi2 / 2; edges of weight 0 are left out. One thread, Eigen's sparse
/// Cholesky: no BLAS whose sums could depend on the number of cores.
SolveReport solve(const PoseGraph& graph, const std::vector<double>& weights, std::size_t max_iterations,
                  double function_tolerance, std::vector<Pose>& T_map_node);

/// Gauss-Newton matrix J^T J over the right tangents of the nodes that move, 6x6 blocks in node order.
/// place_of[node] is the block's place, or size_t(-1) for fixed nodes.
Eigen::SparseMatrix<double> normal_matrix(const PoseGraph& graph, const std::vector<double>& weights,
                                          const std::vector<Pose>& T_map_node, const std::vector<bool>& fixed,
                                          std::vector<std::size_t>& place_of);

}  // namespace loopmark::pose_graph::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "least_squares.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/pose_graph/pose_graph.hpp"
#include "sparse_inverse.hpp"

namespace loopmark::pose_graph {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::vector<double> accepted_weights(const PoseGraphSolution& solution) {
  std::vector<double> weights;
  for (const EdgeReport& report : solution.edges) {
    weights.push_back(report.weight);
  }
  return weights;
}

}  // namespace

std::vector<Matrix6d> marginal_covariances(const PoseGraph& graph, const PoseGraphSolution& solution) {
  if (solution.edges.size() != graph.edges.size() || solution.T_map_node.size() != graph.T_map_node.size()) {
    throw std::invalid_argument("the solution belongs to another pose graph");
  }
  PoseGraph anchored = graph;
  if (anchored.anchors.empty() && !anchored.T_map_node.empty()) {
    anchored.anchors = {0};
  }
  const std::vector<bool> fixed = internal::fixed_nodes(anchored, solution.components);
  std::vector<std::size_t> place_of;
  const Eigen::SparseMatrix<double> normal =
      internal::normal_matrix(anchored, accepted_weights(solution), solution.T_map_node, fixed, place_of);
  const std::vector<Matrix6d> blocks = internal::inverse_diagonal_blocks(normal);
  std::vector<Matrix6d> covariances(graph.T_map_node.size(), Matrix6d::Zero());
  for (std::size_t node = 0; node < covariances.size(); ++node) {
    if (place_of[node] != kNone) {
      const Matrix6d to_map = adjoint(solution.T_map_node[node]);
      covariances[node] = to_map * blocks[place_of[node]] * to_map.transpose();
    }
  }
  return covariances;
}

Matrix6d information_from_covariance(const Matrix6d& covariance, double floor_m, double floor_deg) {
  if (!covariance.allFinite() ||
      (covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-6 * covariance.cwiseAbs().maxCoeff()) {
    throw InputError("covariance of a constraint", "", "it is not finite or not symmetric");
  }
  const double floor_rad = floor_deg * std::numbers::pi / 180.0;
  Matrix6d widened = 0.5 * (covariance + covariance.transpose());
  widened.diagonal().head<3>().array() += floor_m * floor_m;
  widened.diagonal().tail<3>().array() += floor_rad * floor_rad;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(widened);
  const Vector6d variances = solver.eigenvalues().cwiseMax(1e-12);
  return solver.eigenvectors() * variances.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace loopmark::pose_graph

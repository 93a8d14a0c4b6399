// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "least_squares.hpp"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>

#include "disjoint_sets.hpp"
#include "edge_cost.hpp"

namespace loopmark::pose_graph::internal {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

ceres::Solver::Options solver_options(std::size_t max_iterations, double function_tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = static_cast<int>(max_iterations);
  options.function_tolerance = function_tolerance;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  return options;
}

void add_triplets(const Matrix6d& block, std::size_t row, std::size_t column,
                  std::vector<Eigen::Triplet<double>>& triplets) {
  for (int c = 0; c < 6; ++c) {
    for (int r = 0; r < 6; ++r) {
      triplets.emplace_back(static_cast<int>(6 * row) + r, static_cast<int>(6 * column) + c, block(r, c));
    }
  }
}

}  // namespace

std::vector<PoseGraphComponent> find_components(const PoseGraph& graph, const std::vector<double>& weights) {
  const std::size_t count = graph.T_map_node.size();
  DisjointSets sets(count);
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (weights[e] > 0.0) {
      sets.join(graph.edges[e].from, graph.edges[e].to);
    }
  }
  std::vector<std::size_t> place(count, kNone);
  std::vector<PoseGraphComponent> components;
  for (std::size_t node = 0; node < count; ++node) {
    std::size_t& at = place[sets.root(node)];
    if (at == kNone) {
      at = components.size();
      components.emplace_back();
    }
    components[at].nodes.push_back(node);
  }
  for (const std::size_t node : graph.anchors) {
    components[place[sets.root(node)]].anchored = true;
  }
  std::stable_partition(components.begin(), components.end(), [](const PoseGraphComponent& c) { return c.anchored; });
  return components;
}

std::vector<bool> fixed_nodes(const PoseGraph& graph, const std::vector<PoseGraphComponent>& components) {
  std::vector<bool> fixed(graph.T_map_node.size(), false);
  for (const std::size_t node : graph.anchors) {
    fixed[node] = true;
  }
  for (const PoseGraphComponent& component : components) {
    if (!component.anchored) {
      fixed[component.nodes.front()] = true;
    }
  }
  return fixed;
}

SolveReport solve(const PoseGraph& graph, const std::vector<double>& weights, std::size_t max_iterations,
                  double function_tolerance, std::vector<Pose>& T_map_node) {
  std::vector<PoseParameters> parameters;
  parameters.reserve(T_map_node.size());
  std::transform(T_map_node.begin(), T_map_node.end(), std::back_inserter(parameters), to_parameters);
  PoseManifold manifold;
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (PoseParameters& p : parameters) {
    problem.AddParameterBlock(p.data(), 7, &manifold);
  }
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (weights[e] > 0.0) {
      const PoseGraphEdge& edge = graph.edges[e];
      problem.AddResidualBlock(new EdgeCost(edge, weights[e]), nullptr, parameters[edge.from].data(),
                               parameters[edge.to].data());
    }
  }
  const std::vector<bool> fixed = fixed_nodes(graph, find_components(graph, weights));
  for (std::size_t node = 0; node < parameters.size(); ++node) {
    if (fixed[node]) {
      problem.SetParameterBlockConstant(parameters[node].data());
    }
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(max_iterations, function_tolerance), &problem, &summary);
  for (std::size_t node = 0; node < parameters.size(); ++node) {
    if (!fixed[node]) {
      T_map_node[node] = to_pose(parameters[node].data());
    }
  }
  return {summary.termination_type == ceres::CONVERGENCE, summary.iterations.size(), summary.initial_cost,
          summary.final_cost, summary.message};
}

Eigen::SparseMatrix<double> normal_matrix(const PoseGraph& graph, const std::vector<double>& weights,
                                          const std::vector<Pose>& T_map_node, const std::vector<bool>& fixed,
                                          std::vector<std::size_t>& place_of) {
  place_of.assign(T_map_node.size(), kNone);
  std::size_t count = 0;
  for (std::size_t node = 0; node < T_map_node.size(); ++node) {
    if (!fixed[node]) {
      place_of[node] = count++;
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(graph.edges.size() * 144);
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const PoseGraphEdge& edge = graph.edges[e];
    if (weights[e] <= 0.0) {
      continue;
    }
    const Vector6d residual = edge_residual(T_map_node[edge.from], T_map_node[edge.to], edge.T_from_to);
    const EdgeJacobians j = edge_jacobians(residual, edge.T_from_to);
    const Matrix6d information = weights[e] * edge.information;
    const std::size_t a = place_of[edge.from];
    const std::size_t b = place_of[edge.to];
    if (a != kNone) {
      add_triplets(j.from.transpose() * information * j.from, a, a, triplets);
    }
    if (b != kNone) {
      add_triplets(j.to.transpose() * information * j.to, b, b, triplets);
    }
    if (a != kNone && b != kNone) {
      const Matrix6d cross = j.from.transpose() * information * j.to;
      add_triplets(cross, a, b, triplets);
      add_triplets(cross.transpose(), b, a, triplets);
    }
  }
  const auto size = static_cast<Eigen::Index>(6 * count);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace loopmark::pose_graph::internal

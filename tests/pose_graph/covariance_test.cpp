// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "../../libs/pose_graph/src/least_squares.hpp"
#include "../../libs/pose_graph/src/sparse_inverse.hpp"
#include "drives.hpp"
#include "loopmark/core/error.hpp"

namespace loopmark::pose_graph {
namespace {

using namespace testing;

TEST(MarginalCovariances, OfAChainAreTheSumOfItsLinks) {
  Rng rng(1);
  const Drive drive = circuit(1, 60.0, rng);
  const PoseGraphSolution solution = optimize(drive.graph);
  const std::vector<Matrix6d> covariances = marginal_covariances(drive.graph, solution);
  Matrix6d sum = Matrix6d::Zero();
  EXPECT_EQ(covariances[0], sum);
  for (const PoseGraphEdge& edge : drive.graph.edges) {
    const Matrix6d to_map = adjoint(solution.T_map_node[edge.from]);
    sum += to_map * edge.information.inverse() * to_map.transpose();
    EXPECT_LT((covariances[edge.to] - sum).norm(), 1e-6 * sum.norm());
  }
}

TEST(MarginalCovariances, OfALoopedGraphAreTheBlocksOfTheDenseInverse) {
  Rng rng(2);
  Drive drive = circuit(2, 80.0, rng);
  for (std::size_t i = 0; i < 30; i += 7) {
    add_loop(drive, i, i + 41, rng);
  }
  const PoseGraphSolution solution = optimize(drive.graph);
  const std::vector<Matrix6d> covariances = marginal_covariances(drive.graph, solution);
  std::vector<bool> fixed(drive.truth.size(), false);
  fixed[0] = true;
  std::vector<std::size_t> place_of;
  const std::vector<double> weights(drive.graph.edges.size(), 1.0);
  const Eigen::MatrixXd normal = internal::normal_matrix(drive.graph, weights, solution.T_map_node, fixed, place_of);
  const Eigen::MatrixXd inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  for (std::size_t node = 1; node < covariances.size(); ++node) {
    const auto at = static_cast<Eigen::Index>(6 * place_of[node]);
    const Matrix6d to_map = adjoint(solution.T_map_node[node]);
    const Matrix6d expected = to_map * inverse.block<6, 6>(at, at) * to_map.transpose();
    EXPECT_LT((covariances[node] - expected).norm(), 1e-6 * expected.norm()) << node;
  }
}

TEST(MarginalCovariances, AgreeWithTheScatterOfManySolutions) {
  Matrix6d scatter = Matrix6d::Zero();
  Matrix6d predicted = Matrix6d::Zero();
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    Rng rng(static_cast<std::uint64_t>(run) + 10);
    Drive drive = circuit(1, 40.0, rng);
    add_loop(drive, 0, 15, rng);
    PoseGraphOptions options;
    options.robust = false;
    const PoseGraphSolution solution = optimize(drive.graph, options);
    const Vector6d error = log_se3(solution.T_map_node[10] * drive.truth[10].inverse());
    scatter += error * error.transpose() / kRuns;
    predicted = marginal_covariances(drive.graph, solution)[10];
  }
  // The mean of chi2 / 6 over n runs has a standard deviation of sqrt(2 / (6 n)) = 0.03.
  EXPECT_NEAR((predicted.inverse() * scatter).trace() / 6.0, 1.0, 0.12);
}

TEST(MarginalCovariances, RefuseADirectionWithoutConstraint) {
  PoseGraph graph;
  graph.T_map_node.assign(2, Pose::Identity());
  Matrix6d flat = Matrix6d::Identity();
  flat(1, 1) = 0.0;
  graph.edges.push_back({0, 1, Pose::Identity(), flat, EdgeKind::kOdometry});
  EXPECT_THROW(marginal_covariances(graph, optimize(graph)), std::runtime_error);
}

TEST(InformationFromCovariance, AddsTheFloorAndInverts) {
  const Matrix6d information = information_from_covariance(Matrix6d::Zero(), 0.1, 1.0);
  EXPECT_NEAR(information(0, 0), 100.0, 1e-9);
  EXPECT_NEAR(information(5, 5), std::pow(180.0 / std::numbers::pi, 2), 1e-6);
  Matrix6d degenerate = Matrix6d::Zero();
  degenerate(0, 0) = 1e12;
  EXPECT_LT(information_from_covariance(degenerate, 0.1, 1.0)(0, 0), 1e-9);
  degenerate(0, 0) = std::nan("");
  EXPECT_THROW(information_from_covariance(degenerate, 0.1, 1.0), InputError);
}

}  // namespace
}  // namespace loopmark::pose_graph

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "validate.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "loopmark/core/error.hpp"

namespace loopmark::pose_graph::internal {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& problem) {
  throw InputError("pose graph", what, problem, "fix or drop it before solving");
}

bool is_rigid(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  return pose.matrix().allFinite() && (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
         r.determinant() > 0.0;
}

void validate_information(const std::string& name, const Matrix6d& information) {
  if (!information.allFinite()) {
    fail(name, "the information matrix is not finite");
  }
  const double scale = information.cwiseAbs().maxCoeff();
  if ((information - information.transpose()).cwiseAbs().maxCoeff() > 1e-6 * scale) {
    fail(name, "the information matrix is not symmetric");
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information, Eigen::EigenvaluesOnly);
  if (solver.eigenvalues().minCoeff() < -1e-6 * scale) {
    fail(name, "the information matrix has a negative eigenvalue");
  }
}

}  // namespace

void validate(const PoseGraph& graph) {
  const std::size_t count = graph.T_map_node.size();
  for (std::size_t node = 0; node < count; ++node) {
    if (!is_rigid(graph.T_map_node[node])) {
      fail("node " + std::to_string(node), "its pose is no rigid motion");
    }
  }
  for (const std::size_t node : graph.anchors) {
    if (node >= count) {
      fail("anchor " + std::to_string(node), "there is no such node");
    }
  }
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const PoseGraphEdge& edge = graph.edges[e];
    const std::string name =
        "edge " + std::to_string(e) + " (" + std::to_string(edge.from) + " to " + std::to_string(edge.to) + ")";
    if (edge.from >= count || edge.to >= count) {
      fail(name, "there is no such node");
    }
    if (edge.from == edge.to) {
      fail(name, "it joins a node with itself");
    }
    if (!is_rigid(edge.T_from_to)) {
      fail(name, "its motion is no rigid motion");
    }
    validate_information(name, edge.information);
  }
}

}  // namespace loopmark::pose_graph::internal

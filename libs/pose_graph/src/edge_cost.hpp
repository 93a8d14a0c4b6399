// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The one place that says how a pose and a constraint look to Ceres.
#pragma once

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include <array>

#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::pose_graph::internal {

/// A pose as seven numbers: translation, then quaternion x, y, z, w.
using PoseParameters = std::array<double, 7>;

PoseParameters to_parameters(const Pose& pose);
Pose to_pose(const double* parameters);

/// Poses moved on the right: T' = T * exp(xi).
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// log(T_map_from^-1 * T_map_to * T_from_to^-1).
Vector6d edge_residual(const Pose& T_map_from, const Pose& T_map_to, const Pose& T_from_to);

/// Its derivatives by right tangents of the two poses.
struct EdgeJacobians {
  Matrix6d from;
  Matrix6d to;
};
EdgeJacobians edge_jacobians(const Vector6d& residual, const Pose& T_from_to);

/// A matrix S with S^T * S = information; negative eigenvalues count as zero.
Matrix6d square_root(const Matrix6d& information);

/// sqrt(weight) * S * residual.
class EdgeCost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  EdgeCost(const PoseGraphEdge& edge, double weight);
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Pose T_from_to_;
  Matrix6d root_;
};

}  // namespace loopmark::pose_graph::internal

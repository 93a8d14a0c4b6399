// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "edge_cost.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "se3_jacobian.hpp"

namespace loopmark::pose_graph::internal {
namespace {

using RowMajor76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;
using RowMajor67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;

/// Columns q * i, q * j, q * k of the unit quaternion q: orthonormal, tangent to the sphere at q.
Eigen::Matrix<double, 4, 3> quaternion_tangents(const Eigen::Quaterniond& q) {
  Eigen::Matrix<double, 4, 3> m;
  m << q.w(), -q.z(), q.y(),  //
      q.z(), q.w(), -q.x(),   //
      -q.y(), q.x(), q.w(),   //
      -q.x(), -q.y(), -q.z();
  return m;
}

Eigen::Quaterniond quaternion_of(const double* x) { return Eigen::Quaterniond(x[6], x[3], x[4], x[5]); }

/// The 6x7 matrix that turns ambient changes of a pose into right tangents.
RowMajor67 tangent_of_ambient(const double* x) {
  const Eigen::Quaterniond q = quaternion_of(x);
  RowMajor67 m = RowMajor67::Zero();
  m.topLeftCorner<3, 3>() = q.toRotationMatrix().transpose();
  m.bottomRightCorner<3, 4>() = 2.0 * quaternion_tangents(q).transpose();
  return m;
}

}  // namespace

PoseParameters to_parameters(const Pose& pose) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  return {pose.translation().x(), pose.translation().y(), pose.translation().z(), q.x(), q.y(), q.z(), q.w()};
}

Pose to_pose(const double* x) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x[0], x[1], x[2]);
  pose.linear() = quaternion_of(x).normalized().toRotationMatrix();
  return pose;
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const PoseParameters moved = to_parameters(to_pose(x) * exp_se3(Eigen::Map<const Vector6d>(delta)));
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double* x, double* jacobian) const {
  const Eigen::Quaterniond q = quaternion_of(x);
  Eigen::Map<RowMajor76> m(jacobian);
  m.setZero();
  m.topLeftCorner<3, 3>() = q.toRotationMatrix();
  m.bottomRightCorner<4, 3>() = 0.5 * quaternion_tangents(q);
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector6d>{y_minus_x} = log_se3(to_pose(x).inverse() * to_pose(y));
  return true;
}

bool PoseManifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor67> m(jacobian);
  m = tangent_of_ambient(x);
  return true;
}

Vector6d edge_residual(const Pose& T_map_from, const Pose& T_map_to, const Pose& T_from_to) {
  return log_se3(T_map_from.inverse() * T_map_to * T_from_to.inverse());
}

EdgeJacobians edge_jacobians(const Vector6d& residual, const Pose& T_from_to) {
  // E = T_from^-1 T_to Z^-1: a right step of `from` stands left of E, one of `to` moves through Z^-1 by its adjoint.
  return {-left_jacobian_inverse(residual), left_jacobian_inverse(-residual) * adjoint(T_from_to)};
}

Matrix6d square_root(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
}

EdgeCost::EdgeCost(const PoseGraphEdge& edge, double weight)
    : T_from_to_(edge.T_from_to), root_(std::sqrt(weight) * square_root(edge.information)) {}

bool EdgeCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const {
  const Vector6d residual = edge_residual(to_pose(parameters[0]), to_pose(parameters[1]), T_from_to_);
  Eigen::Map<Vector6d>{residuals} = root_ * residual;
  if (jacobians == nullptr) {
    return true;
  }
  const EdgeJacobians by_tangent = edge_jacobians(residual, T_from_to_);
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor67>{jacobians[0]} = root_ * by_tangent.from * tangent_of_ambient(parameters[0]);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<RowMajor67>{jacobians[1]} = root_ * by_tangent.to * tangent_of_ambient(parameters[1]);
  }
  return true;
}

}  // namespace loopmark::pose_graph::internal

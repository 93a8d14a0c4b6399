// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/least_squares/gauss_newton.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace loopmark::least_squares {

void NormalEquations::add_point(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual, double w) {
  const Eigen::Matrix3d cross = hat(moved);
  hessian.topLeftCorner<3, 3>().diagonal().array() += w;
  hessian.topRightCorner<3, 3>() -= w * cross;
  hessian.bottomLeftCorner<3, 3>() += w * cross;
  const double r2 = moved.squaredNorm();
  hessian.bottomRightCorner<3, 3>().noalias() -= w * moved * moved.transpose();
  hessian.bottomRightCorner<3, 3>().diagonal().array() += w * r2;
  gradient.head<3>() += w * residual;
  gradient.tail<3>() += w * moved.cross(residual);
  cost += w * residual.squaredNorm();
  weight += w;
  squared_radius += w * r2;
  residuals += 3;
  ++pairs;
}

void NormalEquations::add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal, double distance, double w) {
  Vector6d jacobian;
  jacobian << normal, arm.cross(normal);
  const Vector6d weighted = w * jacobian;
  hessian.noalias() += weighted * jacobian.transpose();
  gradient += distance * weighted;
  cost += w * distance * distance;
  weight += w;
  squared_radius += w * arm.squaredNorm();
  ++residuals;
  ++pairs;
}

void NormalEquations::add_general(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual,
                                  const Eigen::Matrix3d& information, double w) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << Eigen::Matrix3d::Identity(), -hat(moved);
  const Eigen::Matrix<double, 3, 6> weighted = w * (information * jacobian);
  hessian.noalias() += jacobian.transpose() * weighted;
  gradient.noalias() += weighted.transpose() * residual;
  cost += w * residual.dot(information * residual);
  weight += w;
  squared_radius += w * moved.squaredNorm();
  ++residuals;
  ++pairs;
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  hessian += other.hessian;
  gradient += other.gradient;
  cost += other.cost;
  weight += other.weight;
  squared_radius += other.squared_radius;
  residuals += other.residuals;
  pairs += other.pairs;
  return *this;
}

namespace {

/// Scales xi so that rotations count as metres at the radius of the points.
Vector6d scale_of(double radius_m) {
  Vector6d scale;
  scale << 1, 1, 1, 1 / radius_m, 1 / radius_m, 1 / radius_m;
  return scale;
}

}  // namespace

int Constraint::weak(double threshold) const { return static_cast<int>((strengths.array() < threshold).count()); }

Constraint constraint_of(const NormalEquations& equations) {
  Constraint constraint;
  if (!(equations.weight > 0.0)) {
    return constraint;
  }
  constraint.radius_m = std::max(1e-6, std::sqrt(equations.squared_radius / equations.weight));
  const Vector6d scale = scale_of(constraint.radius_m);
  const Matrix6d scaled = scale.asDiagonal() * equations.hessian * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled / equations.weight);
  constraint.strengths = solver.eigenvalues().cwiseMax(0.0);
  constraint.directions = solver.eigenvectors();
  return constraint;
}

Vector6d gauss_newton_step(const NormalEquations& equations, double min_strength) {
  const Constraint constraint = constraint_of(equations);
  const Vector6d scale = scale_of(constraint.radius_m);
  Vector6d along = constraint.directions.transpose() * (scale.asDiagonal() * equations.gradient);
  for (int i = 0; i < 6; ++i) {
    const double strength = constraint.strengths[i];
    along[i] = strength > min_strength ? -along[i] / (strength * equations.weight) : 0.0;
  }
  return scale.asDiagonal() * (constraint.directions * along);
}

Uncertainty uncertainty_of(const NormalEquations& equations, double residual_variance, double largest_sigma) {
  const Constraint constraint = constraint_of(equations);
  const Vector6d scale = scale_of(constraint.radius_m);
  const double least = 1.0 / (largest_sigma * largest_sigma);
  const Vector6d information = (constraint.strengths * (equations.weight / residual_variance)).cwiseMax(least);
  const Matrix6d to_information = scale.cwiseInverse().asDiagonal() * constraint.directions;
  const Matrix6d to_covariance = scale.asDiagonal() * constraint.directions;
  return {to_information * information.asDiagonal() * to_information.transpose(),
          to_covariance * information.cwiseInverse().asDiagonal() * to_covariance.transpose()};
}

Pose move_about(const Eigen::Vector3d& centre, const Vector6d& xi) {
  return Eigen::Translation3d(centre) * exp_se3(xi) * Eigen::Translation3d(-centre);
}

Uncertainty about_origin(const Uncertainty& uncertainty, const Eigen::Vector3d& centre) {
  Pose shift = Pose::Identity();
  shift.translation() = centre;
  const Matrix6d to_origin = adjoint(shift);
  const Matrix6d to_centre = adjoint(shift.inverse());
  return {to_centre.transpose() * uncertainty.information * to_centre,
          to_origin * uncertainty.covariance * to_origin.transpose()};
}

}  // namespace loopmark::least_squares

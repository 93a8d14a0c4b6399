// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/least_squares/pair_equations.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace loopmark::least_squares {

void PairEquations::count(const Eigen::Vector3d& arm, double squared_residual, double w, std::size_t scalars) {
  cost += w * squared_residual;
  weight += w;
  squared_radius += w * arm.squaredNorm();
  residuals += scalars;
  ++pairs;
}

void PairEquations::add_point(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual, double w) {
  add_point_to_point(*this, moved, residual, w);
  count(moved, residual.squaredNorm(), w, 3);
}

void PairEquations::add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal, double distance, double w) {
  add_point_to_plane(*this, arm, normal, distance, w);
  count(arm, distance * distance, w, 1);
}

void PairEquations::add_general(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual,
                                const Eigen::Matrix3d& information, double w) {
  add_generalized(*this, moved, residual, information, w);
  count(moved, residual.dot(information * residual), w, 1);
}

PairEquations& PairEquations::operator+=(const PairEquations& other) {
  NormalEquations<6>::operator+=(other);
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

Constraint constraint_of(const PairEquations& equations) {
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

Vector6d gauss_newton_step(const PairEquations& equations, double min_strength) {
  const Constraint constraint = constraint_of(equations);
  const Vector6d scale = scale_of(constraint.radius_m);
  Vector6d along = constraint.directions.transpose() * (scale.asDiagonal() * equations.gradient);
  for (int i = 0; i < 6; ++i) {
    const double strength = constraint.strengths[i];
    along[i] = strength > min_strength ? -along[i] / (strength * equations.weight) : 0.0;
  }
  return scale.asDiagonal() * (constraint.directions * along);
}

Uncertainty uncertainty_of(const PairEquations& equations, double residual_variance, double largest_sigma) {
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

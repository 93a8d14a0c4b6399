// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The Gauss-Newton step on given correspondences, for every local registration of loopmark. The motion is
/// updated from the left, T <- exp(xi) * T, xi = [translation; rotation].
#pragma once

#include <cstddef>

#include "loopmark/core/pose.hpp"

namespace loopmark::least_squares {

/// Sums over correspondences of J^T W J, J^T W e and e^T W e. `moved` is always the source point already moved into
/// the target frame, minus `centre` if one is used (see move_about): far from the origin a centre near the
/// points keeps the sums well conditioned. Partial sums are added in a fixed order by the caller
/// (parallel_reduce_ordered), so that the result does not depend on the number of threads.
struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0.0;            ///< sum of weight * squared residual
  double weight = 0.0;          ///< sum of weights
  double squared_radius = 0.0;  ///< sum of weight * |moved|^2
  std::size_t residuals = 0;    ///< scalar residuals: 3 a point pair, 1 a plane or general pair
  std::size_t pairs = 0;

  /// Point to point: e = moved - target.
  void add_point(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual, double w);
  /// Point to plane: e = normal . (moved - target). `arm` is the lever of the rotation: `moved`, or the middle of
  /// the two points in symmetric ICP.
  void add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal, double distance, double w);
  /// Any 3 x 3 information matrix (Generalized-ICP): cost e^T * information * e. Counts as one residual, because
  /// nearly all the information of a surface pair is along its normal.
  void add_general(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual, const Eigen::Matrix3d& information,
                   double w);
  NormalEquations& operator+=(const NormalEquations& other);
};

/// How well a set of correspondences fixes the motion: eigenvalues (ascending) and eigenvectors (columns) of the
/// Hessian for one unit of weight, with rotations measured by the movement that they cause at the root-mean-square
/// radius of the points. For point-to-plane the six values lie between 0 (free) and about 1.
struct Constraint {
  Vector6d strengths = Vector6d::Zero();
  Matrix6d directions = Matrix6d::Identity();
  double radius_m = 1.0;

  /// Number of directions weaker than `threshold`.
  int weak(double threshold) const;
};

Constraint constraint_of(const NormalEquations& equations);

/// The step xi that minimises the sums; it does not move along directions weaker than `min_strength`.
Vector6d gauss_newton_step(const NormalEquations& equations, double min_strength = 1e-6);

/// Information of xi given the variance of one residual, and its inverse. Free directions get no more than
/// `largest_sigma` metres (at the radius of the constraint), so that the covariance widens along them but stays finite.
struct Uncertainty {
  Matrix6d information = Matrix6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
};
Uncertainty uncertainty_of(const NormalEquations& equations, double residual_variance, double largest_sigma = 10.0);

/// exp(xi) taken about `centre`: the rigid motion p -> centre + exp(xi) (p - centre).
Pose move_about(const Eigen::Vector3d& centre, const Vector6d& xi);

/// Moves an uncertainty of xi about `centre` to one about the origin.
Uncertainty about_origin(const Uncertainty& uncertainty, const Eigen::Vector3d& centre);

}  // namespace loopmark::least_squares

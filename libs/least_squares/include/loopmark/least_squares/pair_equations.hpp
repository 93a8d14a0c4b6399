// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The sums over point pairs of a local registration, and how well they fix the motion.
#pragma once

#include <cstddef>

#include "loopmark/core/pose.hpp"
#include "loopmark/least_squares/factors.hpp"

namespace loopmark::least_squares {

/// The normal equations of point pairs with what a judgement of them needs. `moved` is always the source point already
/// moved into the target frame, minus `centre` if one is used (see move_about): far from the origin a centre near the
/// points keeps the sums well conditioned.
struct PairEquations : NormalEquations<6> {
  double cost = 0.0;            ///< sum of weight * squared residual
  double weight = 0.0;          ///< sum of weights
  double squared_radius = 0.0;  ///< sum of weight * |moved|^2
  std::size_t residuals = 0;    ///< scalar residuals: 3 a point pair, 1 a plane or general pair
  std::size_t pairs = 0;

  /// The factors of factors.hpp. A general pair counts as one residual, because nearly all the information of a surface
  /// pair is along its normal.
  void add_point(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual, double w);
  void add_plane(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal, double distance, double w);
  void add_general(const Eigen::Vector3d& moved, const Eigen::Vector3d& residual, const Eigen::Matrix3d& information,
                   double w);
  PairEquations& operator+=(const PairEquations& other);

 private:
  void count(const Eigen::Vector3d& arm, double squared_residual, double w, std::size_t scalars);
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

Constraint constraint_of(const PairEquations& equations);

/// The step xi that minimises the sums; it does not move along directions weaker than `min_strength`.
Vector6d gauss_newton_step(const PairEquations& equations, double min_strength = 1e-6);

/// Information of xi given the variance of one residual, and its inverse. Free directions get no more than
/// `largest_sigma` metres (at the radius of the constraint), so that the covariance widens along them but stays finite.
struct Uncertainty {
  Matrix6d information = Matrix6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
};
Uncertainty uncertainty_of(const PairEquations& equations, double residual_variance, double largest_sigma = 10.0);

/// exp(xi) taken about `centre`: the rigid motion p -> centre + exp(xi) (p - centre).
Pose move_about(const Eigen::Vector3d& centre, const Vector6d& xi);

/// Moves an uncertainty of xi about `centre` to one about the origin.
Uncertainty about_origin(const Uncertainty& uncertainty, const Eigen::Vector3d& centre);

}  // namespace loopmark::least_squares

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/least_squares/pair_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "loopmark/core/random.hpp"
#include "loopmark/least_squares/robust_kernel.hpp"

namespace loopmark::least_squares {
namespace {

Eigen::Vector3d random_vector(Rng& rng, double size) {
  return size * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
}

/// The gradient of half the cost by central differences of cost(exp(xi) * p).
template <class Cost>
Vector6d numeric_gradient(const Cost& cost) {
  Vector6d gradient;
  for (int k = 0; k < 6; ++k) {
    Vector6d xi = Vector6d::Zero();
    xi[k] = 1e-6;
    gradient[k] = (cost(exp_se3(xi)) - cost(exp_se3(-xi))) / 4e-6;
  }
  return gradient;
}

TEST(GaussNewton, GradientsAgreeWithFiniteDifferences) {
  Rng rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d p = random_vector(rng, 5.0);
    const Eigen::Vector3d q = random_vector(rng, 5.0);
    const Eigen::Vector3d n = random_vector(rng, 1.0).normalized();
    const Eigen::Matrix3d information = (Eigen::Matrix3d() << 2, 0.3, 0, 0.3, 1, 0.2, 0, 0.2, 3).finished();
    PairEquations point, plane, general;
    point.add_point(p, p - q, 0.7);
    plane.add_plane(p, n, n.dot(p - q), 0.7);
    general.add_general(p, p - q, information, 0.7);
    const auto near = [&](const PairEquations& sums, const auto& cost) {
      EXPECT_LT((sums.gradient - numeric_gradient(cost)).norm(), 1e-4 * (1 + sums.gradient.norm()));
      EXPECT_NEAR(sums.cost, cost(Pose::Identity()), 1e-9);
      EXPECT_LT((sums.hessian - sums.hessian.transpose()).norm(), 1e-12);
    };
    near(point, [&](const Pose& T) { return 0.7 * (T * p - q).squaredNorm(); });
    near(plane, [&](const Pose& T) { return 0.7 * std::pow(n.dot(T * p - q), 2); });
    near(general, [&](const Pose& T) -> double { return 0.7 * (T * p - q).dot(information * (T * p - q)); });
  }
}

TEST(GaussNewton, PointPairsWithIdentityInformationAreGeneralPairs) {
  Rng rng(2);
  PairEquations point, general;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d p = random_vector(rng, 3.0);
    const Eigen::Vector3d e = random_vector(rng, 0.1);
    point.add_point(p, e, 0.4);
    general.add_general(p, e, Eigen::Matrix3d::Identity(), 0.4);
  }
  EXPECT_LT((point.hessian - general.hessian).norm(), 1e-9);
  EXPECT_LT((point.gradient - general.gradient).norm(), 1e-12);
}

TEST(GaussNewton, DoesNotMoveAlongFreeDirections) {
  Rng rng(3);
  PairEquations sums;  // two walls along x and the ground: x is free
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = random_vector(rng, 5.0);
    sums.add_plane(p, i % 2 == 0 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ(), 0.1, 1.0);
  }
  const Constraint constraint = constraint_of(sums);
  EXPECT_EQ(constraint.weak(0.01), 1);
  EXPECT_NEAR(std::abs(constraint.directions(0, 0)), 1.0, 1e-6);
  EXPECT_NEAR(gauss_newton_step(sums)[0], 0.0, 1e-12);
  const Uncertainty uncertainty = uncertainty_of(sums, 1e-4, 5.0);
  EXPECT_NEAR(std::sqrt(uncertainty.covariance(0, 0)), 5.0, 1e-6);
  EXPECT_LT(std::sqrt(uncertainty.covariance(1, 1)), 0.01);
}

TEST(GaussNewton, UncertaintyMovesWithTheCentre) {
  Rng rng(4);
  const Eigen::Vector3d centre(30, -20, 4);
  PairEquations about_zero, about_centre;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = centre + random_vector(rng, 8.0);
    const Eigen::Vector3d n = random_vector(rng, 1.0).normalized();
    about_zero.add_plane(p, n, 0.02, 1.0);
    about_centre.add_plane(p - centre, n, 0.02, 1.0);
  }
  const Uncertainty a = uncertainty_of(about_zero, 1e-4, 1e9);
  const Uncertainty b = about_origin(uncertainty_of(about_centre, 1e-4, 1e9), centre);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-6 * a.covariance.norm());
  EXPECT_LT((b.covariance * b.information - Matrix6d::Identity()).norm(), 1e-6);
  const Pose step_a = exp_se3(gauss_newton_step(about_zero));
  const Pose step_b = move_about(centre, gauss_newton_step(about_centre));
  EXPECT_LT((step_a.matrix() - step_b.matrix()).norm(), 1e-3);
}

TEST(RobustKernel, WeightIsTheDerivativeOfTheLoss) {
  for (const RobustKernel kernel : {RobustKernel::kNone, RobustKernel::kHuber, RobustKernel::kCauchy,
                                    RobustKernel::kGemanMcClure, RobustKernel::kTukey, RobustKernel::kTruncated}) {
    EXPECT_EQ(robust_weight(kernel, 0.0, 0.3), 1.0);
    EXPECT_EQ(robust_loss(kernel, 0.0, 0.3), 0.0);
    for (const double r2 : {0.01, 0.05, 0.2, 1.0}) {
      const double slope = (robust_loss(kernel, r2 + 1e-7, 0.3) - robust_loss(kernel, r2 - 1e-7, 0.3)) / 2e-7;
      EXPECT_NEAR(robust_weight(kernel, r2, 0.3), slope, 1e-5);
    }
  }
}

}  // namespace
}  // namespace loopmark::least_squares

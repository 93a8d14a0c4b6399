// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "../../libs/pose_graph/src/edge_cost.hpp"

#include <gtest/gtest.h>

#include "../../libs/pose_graph/src/se3_jacobian.hpp"
#include "drives.hpp"

namespace loopmark::pose_graph {
namespace {

Vector6d random_tangent(Rng& rng, double metres, double radians) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) {
    xi[i] = rng.uniform(-1.0, 1.0) * (i < 3 ? metres : radians);
  }
  return xi;
}

/// Central differences of f at zero, column by column.
template <class F>
Matrix6d differences(const F& f, double step = 1e-6) {
  Matrix6d m;
  for (int c = 0; c < 6; ++c) {
    const Vector6d d = step * Vector6d::Unit(c);
    m.col(c) = (f(d) - f(-d)) / (2.0 * step);
  }
  return m;
}

TEST(LeftJacobianInverse, AgreesWithFiniteDifferences) {
  Rng rng(1);
  for (const double radians : {1e-9, 1e-3, 0.04, 0.06, 0.5, 1.7}) {
    for (int i = 0; i < 10; ++i) {
      const Vector6d xi = random_tangent(rng, 5.0, radians);
      const Matrix6d numeric = differences([&](const Vector6d& d) { return log_se3(exp_se3(d) * exp_se3(xi)); });
      EXPECT_LT((internal::left_jacobian_inverse(xi) - numeric).norm(), 1e-6) << xi.transpose();
    }
  }
}

TEST(EdgeJacobians, AgreeWithFiniteDifferences) {
  Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    const Pose a = exp_se3(random_tangent(rng, 50.0, 1.5));
    const Pose z = exp_se3(random_tangent(rng, 10.0, 1.5));
    const Pose b = a * z * exp_se3(random_tangent(rng, 1.0, 0.5));
    const internal::EdgeJacobians j = internal::edge_jacobians(internal::edge_residual(a, b, z), z);
    const Matrix6d from = differences([&](const Vector6d& d) { return internal::edge_residual(a * exp_se3(d), b, z); });
    const Matrix6d to = differences([&](const Vector6d& d) { return internal::edge_residual(a, b * exp_se3(d), z); });
    EXPECT_LT((j.from - from).norm(), 1e-5);
    EXPECT_LT((j.to - to).norm(), 1e-5);
  }
}

TEST(PoseManifold, KeepsTheRulesOfAManifold) {
  Rng rng(3);
  const internal::PoseManifold manifold;
  for (int i = 0; i < 20; ++i) {
    const internal::PoseParameters x = internal::to_parameters(exp_se3(random_tangent(rng, 50.0, 1.5)));
    const Vector6d d = random_tangent(rng, 1.0, 0.7);
    internal::PoseParameters y{};
    Vector6d back;
    manifold.Plus(x.data(), d.data(), y.data());
    manifold.Minus(y.data(), x.data(), back.data());
    EXPECT_LT((back - d).norm(), 1e-9);
    Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
    Eigen::Matrix<double, 6, 7, Eigen::RowMajor> minus;
    manifold.PlusJacobian(x.data(), plus.data());
    manifold.MinusJacobian(x.data(), minus.data());
    EXPECT_LT((minus * plus - Matrix6d::Identity()).norm(), 1e-12);
    Eigen::Matrix<double, 7, 6> numeric;
    for (int c = 0; c < 6; ++c) {
      const Vector6d step = 1e-7 * Vector6d::Unit(c);
      manifold.Plus(x.data(), step.data(), y.data());
      numeric.col(c) = (Eigen::Map<Eigen::Matrix<double, 7, 1>>(y.data()) -
                        Eigen::Map<const Eigen::Matrix<double, 7, 1>>(x.data())) /
                       1e-7;
    }
    EXPECT_LT((plus - numeric).norm(), 1e-5);
  }
}

TEST(EdgeCost, WeighsTheResidualByTheRootOfTheInformation) {
  Rng rng(4);
  const Matrix6d half = Matrix6d::Random();
  const PoseGraphEdge edge{0, 1, exp_se3(random_tangent(rng, 3.0, 1.0)), half * half.transpose(), EdgeKind::kLoop};
  const Pose a = exp_se3(random_tangent(rng, 3.0, 1.0));
  const Pose b = a * edge.T_from_to * exp_se3(random_tangent(rng, 0.3, 0.1));
  const internal::PoseParameters pa = internal::to_parameters(a);
  const internal::PoseParameters pb = internal::to_parameters(b);
  const double* blocks[] = {pa.data(), pb.data()};
  Vector6d weighted;
  internal::EdgeCost(edge, 0.25).Evaluate(blocks, weighted.data(), nullptr);
  const Vector6d residual = internal::edge_residual(a, b, edge.T_from_to);
  EXPECT_NEAR(weighted.squaredNorm(), 0.25 * residual.dot(edge.information * residual), 1e-9);
}

}  // namespace
}  // namespace loopmark::pose_graph

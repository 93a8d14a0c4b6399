// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/pose.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "loopmark/core/random.hpp"

namespace loopmark {
namespace {

Vector6d random_tangent(Rng& rng, double rotation) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) {
    xi[i] = rng.uniform(-1.0, 1.0) * (i < 3 ? 10.0 : rotation);
  }
  return xi;
}

TEST(Pose, LogInvertsExp) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const Vector6d xi = random_tangent(rng, i % 2 == 0 ? 1.7 : 1e-7);
    EXPECT_LT((log_se3(exp_se3(xi)) - xi).norm(), 1e-8);
  }
}

TEST(Pose, AdjointMovesTangentThroughThePose) {
  Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    const Pose T = exp_se3(random_tangent(rng, 1.5));
    const Vector6d xi = random_tangent(rng, 1.0);
    const Pose left = T * exp_se3(xi) * T.inverse();
    EXPECT_LT((left.matrix() - exp_se3(adjoint(T) * xi).matrix()).norm(), 1e-6);
  }
}

TEST(Pose, EulerFollowsTheBalancedSets) {
  const Eigen::Vector3d rpy(3.0, -7.0, 120.0);
  EXPECT_LT((euler_degrees(rotation_from_euler_degrees(rpy)) - rpy).norm(), 1e-9);
  // Rz(90) maps x to y.
  EXPECT_LT((rotation_from_euler_degrees({0, 0, 90}) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
            1e-12);
}

TEST(Pose, ErrorIsTheAngleAndTheDistance) {
  Pose estimate = Pose::Identity();
  estimate.linear() = rotation_from_euler_degrees({0, 0, 30});
  estimate.translation() = Eigen::Vector3d(3, 4, 0);
  const PoseError error = pose_error(estimate, Pose::Identity());
  EXPECT_NEAR(error.rotation_deg, 30.0, 1e-9);
  EXPECT_NEAR(error.translation_m, 5.0, 1e-12);
}

TEST(Pose, RefusesWhatIsNotRigid) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  EXPECT_NO_THROW(rigid_from_matrix(matrix));
  matrix(0, 0) = -1.0;
  EXPECT_THROW(rigid_from_matrix(matrix), std::invalid_argument);
  matrix(0, 0) = 1.1;
  EXPECT_THROW(rigid_from_matrix(matrix), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark

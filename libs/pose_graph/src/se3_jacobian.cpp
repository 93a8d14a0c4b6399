// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "se3_jacobian.hpp"

#include <cmath>

namespace loopmark::pose_graph::internal {
namespace {

/// Coefficients of the closed forms; series below 0.05 rad, where the fractions lose digits.
struct Coefficients {
  double so3;         ///< of phi^ phi^ in the inverse left Jacobian of SO(3)
  double q1, q2, q3;  ///< of the three brackets of Q

  explicit Coefficients(double angle) {
    const double a2 = angle * angle;
    if (angle < 0.05) {
      so3 = 1.0 / 12.0 + a2 / 720.0 + a2 * a2 / 30240.0;
      q1 = 1.0 / 6.0 - a2 / 120.0 + a2 * a2 / 5040.0;
      q2 = 1.0 / 24.0 - a2 / 720.0 + a2 * a2 / 40320.0;
      q3 = 1.0 / 120.0 - a2 / 2520.0 + a2 * a2 / 120960.0;
      return;
    }
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    so3 = (1.0 - 0.5 * angle * sine / (1.0 - cosine)) / a2;
    q1 = (angle - sine) / (a2 * angle);
    q2 = (0.5 * a2 + cosine - 1.0) / (a2 * a2);
    q3 = (angle - 1.5 * sine + 0.5 * angle * cosine) / (a2 * a2 * angle);
  }
};

}  // namespace

Matrix6d left_jacobian_inverse(const Vector6d& xi) {
  const Eigen::Matrix3d p = hat(xi.head<3>());
  const Eigen::Matrix3d f = hat(xi.tail<3>());
  const Coefficients c(xi.tail<3>().norm());
  const Eigen::Matrix3d fp = f * p;
  const Eigen::Matrix3d pf = p * f;
  const Eigen::Matrix3d fpf = fp * f;
  const Eigen::Matrix3d q =
      0.5 * p + c.q1 * (fp + pf + fpf) + c.q2 * (f * fp + pf * f - 3.0 * fpf) + c.q3 * (fpf * f + f * fpf);
  const Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity() - 0.5 * f + c.so3 * f * f;
  Matrix6d inverse = Matrix6d::Zero();
  inverse.topLeftCorner<3, 3>() = rotation;
  inverse.bottomRightCorner<3, 3>() = rotation;
  inverse.topRightCorner<3, 3>() = -rotation * q * rotation;
  return inverse;
}

}  // namespace loopmark::pose_graph::internal

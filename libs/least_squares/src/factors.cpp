// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/least_squares/factors.hpp"

namespace loopmark::least_squares {

void add_point_to_point(NormalEquations<6>& sums, const Eigen::Vector3d& moved, const Eigen::Vector3d& residual,
                        double w) {
  const Eigen::Matrix3d cross = hat(moved);
  sums.hessian.topLeftCorner<3, 3>().diagonal().array() += w;
  sums.hessian.topRightCorner<3, 3>() -= w * cross;
  sums.hessian.bottomLeftCorner<3, 3>() += w * cross;
  sums.hessian.bottomRightCorner<3, 3>().noalias() -= w * moved * moved.transpose();
  sums.hessian.bottomRightCorner<3, 3>().diagonal().array() += w * moved.squaredNorm();
  sums.gradient.head<3>() += w * residual;
  sums.gradient.tail<3>() += w * moved.cross(residual);
}

void add_point_to_plane(NormalEquations<6>& sums, const Eigen::Vector3d& arm, const Eigen::Vector3d& normal,
                        double distance, double w) {
  Vector6d jacobian;
  jacobian << normal, arm.cross(normal);
  sums.add_row(jacobian, distance, w);
}

void add_generalized(NormalEquations<6>& sums, const Eigen::Vector3d& moved, const Eigen::Vector3d& residual,
                     const Eigen::Matrix3d& information, double w) {
  // J = [I, -hat(moved)]: J^T W J in blocks.
  const Eigen::Matrix3d weighted = w * information;
  const Eigen::Matrix3d cross = hat(moved);
  const Eigen::Matrix3d turned = weighted * cross;
  const Eigen::Vector3d pull = weighted * residual;
  sums.hessian.topLeftCorner<3, 3>() += weighted;
  sums.hessian.topRightCorner<3, 3>() -= turned;
  sums.hessian.bottomLeftCorner<3, 3>() -= turned.transpose();
  sums.hessian.bottomRightCorner<3, 3>().noalias() -= cross * turned;
  sums.gradient.head<3>() += pull;
  sums.gradient.tail<3>() += moved.cross(pull);
}

}  // namespace loopmark::least_squares

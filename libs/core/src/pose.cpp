// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace loopmark {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Left Jacobian of SO(3), which turns rho into the translation of exp([rho; phi]).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d k = hat(phi);
  if (angle < 1e-5) {
    return Eigen::Matrix3d::Identity() + 0.5 * k + k * k / 6.0;
  }
  const double a = (1.0 - std::cos(angle)) / (angle * angle);
  const double b = (angle - std::sin(angle)) / (angle * angle * angle);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd angle_axis{Eigen::Quaterniond(rotation).normalized()};
  double angle = angle_axis.angle();
  if (angle > std::numbers::pi) {
    angle -= 2.0 * std::numbers::pi;
  }
  return angle * angle_axis.axis();
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  if (angle < 1e-12) {
    return Eigen::Matrix3d::Identity() + hat(phi);
  }
  return Eigen::AngleAxisd(angle, phi / angle).toRotationMatrix();
}

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Pose exp_se3(const Vector6d& xi) {
  Pose pose = Pose::Identity();
  const Eigen::Vector3d phi = xi.tail<3>();
  pose.linear() = exp_so3(phi);
  pose.translation() = left_jacobian(phi) * xi.head<3>();
  return pose;
}

Vector6d log_se3(const Pose& pose) {
  const Eigen::Vector3d phi = log_so3(pose.linear());
  Vector6d xi;
  xi.tail<3>() = phi;
  xi.head<3>() = left_jacobian(phi).partialPivLu().solve(pose.translation());
  return xi;
}

Matrix6d adjoint(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = r;
  m.bottomRightCorner<3, 3>() = r;
  m.topRightCorner<3, 3>() = hat(pose.translation()) * r;
  return m;
}

Eigen::Vector3d euler_degrees(const Eigen::Matrix3d& r) {
  const double pitch = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  const double roll = std::atan2(r(2, 1), r(2, 2));
  const double yaw = std::atan2(r(1, 0), r(0, 0));
  return Eigen::Vector3d(roll, pitch, yaw) * kDegrees;
}

Eigen::Matrix3d rotation_from_euler_degrees(const Eigen::Vector3d& roll_pitch_yaw) {
  const Eigen::Vector3d a = roll_pitch_yaw / kDegrees;
  return (Eigen::AngleAxisd(a.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(a.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(a.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Pose pose_from_yaw(double yaw_rad, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

double rotation_angle_degrees(const Eigen::Matrix3d& rotation) {
  return std::acos(std::clamp(0.5 * (rotation.trace() - 1.0), -1.0, 1.0)) * kDegrees;
}

PoseError pose_error(const Pose& estimate, const Pose& truth) {
  return {(estimate.translation() - truth.translation()).norm(),
          rotation_angle_degrees(estimate.linear().transpose() * truth.linear())};
}

Pose interpolate(const Pose& a, const Pose& b, double ratio) { return a * exp_se3(ratio * log_se3(a.inverse() * b)); }

Pose rigid_from_matrix(const Eigen::Matrix4d& matrix, double tolerance) {
  const Eigen::Matrix3d m = matrix.topLeftCorner<3, 3>();
  const Eigen::RowVector4d last(0.0, 0.0, 0.0, 1.0);
  const bool orthonormal = matrix.allFinite() && (m.transpose() * m - Eigen::Matrix3d::Identity()).norm() < tolerance;
  if (!orthonormal || m.determinant() < 0.0 || (matrix.row(3) - last).norm() > tolerance) {
    throw std::invalid_argument("the matrix is no rigid motion");
  }
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(m).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

}  // namespace loopmark

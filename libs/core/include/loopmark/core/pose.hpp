// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Rigid motions. A pose named T_a_b maps points of frame b into frame a: p_a = T_a_b * p_b.
/// Tangent vectors are [translation; rotation], translation first, everywhere in loopmark.
#pragma once

#include <Eigen/Geometry>

namespace loopmark {

using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Skew-symmetric matrix of v: hat(v) * w = v x w.
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// SE(3) exponential of xi = [rho; phi] (metres; radians).
Pose exp_se3(const Vector6d& xi);

/// SE(3) logarithm, inverse of exp_se3; the rotation part has norm at most pi.
Vector6d log_se3(const Pose& pose);

/// Adjoint of the pose: T * exp(xi) * T^-1 = exp(adjoint(T) * xi), for [translation; rotation] tangents.
Matrix6d adjoint(const Pose& pose);

/// Roll, pitch, yaw in degrees of R = Rz(yaw) * Ry(pitch) * Rx(roll), the convention of the balanced sets.
Eigen::Vector3d euler_degrees(const Eigen::Matrix3d& rotation);

/// Rotation of roll, pitch, yaw in degrees; inverse of euler_degrees.
Eigen::Matrix3d rotation_from_euler_degrees(const Eigen::Vector3d& roll_pitch_yaw);

/// Pose of a yaw (radians) about z and a translation (metres).
Pose pose_from_yaw(double yaw_rad, const Eigen::Vector3d& translation = Eigen::Vector3d::Zero());

/// Angle of a rotation in degrees, in [0, 180]; the arccos argument is clamped (paper, Sec. 5: RE).
double rotation_angle_degrees(const Eigen::Matrix3d& rotation);

/// How far an estimate is from the truth: the paper's TE (metres) and RE (degrees).
struct PoseError {
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};

/// TE = |t_estimate - t_truth|, RE = angle(R_estimate^T R_truth).
PoseError pose_error(const Pose& estimate, const Pose& truth);

/// Interpolates from a (at ratio 0) to b (at ratio 1) on the geodesic; ratios outside [0, 1] extrapolate.
Pose interpolate(const Pose& a, const Pose& b, double ratio);

/// The nearest rigid motion to a 4x4 matrix, row-major. Throws std::invalid_argument when the
/// matrix is further than `tolerance` from rigid (orthonormality, determinant, last row).
Pose rigid_from_matrix(const Eigen::Matrix4d& matrix, double tolerance = 1e-3);

}  // namespace loopmark

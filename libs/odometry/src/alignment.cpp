// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/alignment.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "loopmark/least_squares/factors.hpp"
#include "loopmark/least_squares/robust_kernel.hpp"

namespace loopmark::odometry {
namespace {

constexpr std::size_t kBlock = 512;     // keypoints of one partial sum
constexpr double kNoPlaneWeight = 0.2;  // of a match whose surface is no plane
constexpr double kAlongAxis = 0.05;     // of the same along the sensor's axis: holds the height where no plane does
constexpr double kInlierVoxels = 0.2;   // an inlier is nearer to its surface than this many voxels
constexpr double kConverged = 1e-4;     // step, metres and radians
constexpr std::size_t kFewestInliers = 6;

/// Sums over the keypoints. The tangent is [translation; rotation about the sensor], both along the map's axes.
struct MatchEquations : least_squares::NormalEquations<6> {
  Matrix6d H_planes = Matrix6d::Zero();  // inliers on planes only, weight 1: what really holds the scan
  double squares = 0.0;                  // of the inliers' distances
  std::size_t inliers = 0;
  std::size_t matches = 0;
  std::size_t left_out = 0;  // ground that says nothing
  std::size_t structure_inliers = 0;

  MatchEquations& operator+=(const MatchEquations& other) {
    NormalEquations<6>::operator+=(other);
    H_planes += other.H_planes;
    squares += other.squares;
    inliers += other.inliers;
    matches += other.matches;
    left_out += other.left_out;
    structure_inliers += other.structure_inliers;
    return *this;
  }
};

struct Kernel {
  double scale_m;
  double inlier_m;
  double point_weight;
};

/// Weight of a distance that no plane measures, by direction, map frame. Hardly anything counts along the axis about
/// which the sensor turns: there lie the rings that its beams draw on walls, which go up and down with the distance to
/// the wall and not with the sensor. Drawn together they pitch the map: upwards where most of what is seen stands above
/// the horizon (VLP-16: 4 degrees in 100 m at the start of a drive).
Eigen::Matrix3d weight_along(const Pose& T) {
  const Eigen::Vector3d axis = T.linear().col(2);
  return Eigen::Matrix3d::Identity() - (1.0 - kAlongAxis) * axis * axis.transpose();
}

/// Ground counts across its plane only: along it lie the rings of the sensor, which go where the sensor goes.
void add_match(MatchEquations& sums, const Eigen::Vector3d& lever, const Eigen::Vector3d& error,
               const Eigen::Vector3d& normal, const Kernel& kernel, const Eigen::Matrix3d& along, bool ground) {
  const bool plane = !normal.isZero(0.0);
  if (ground && !plane) {
    ++sums.left_out;
    return;
  }
  ++sums.matches;
  const double across = plane ? normal.dot(error) : error.norm();
  const double robust =
      least_squares::robust_weight(least_squares::RobustKernel::kGemanMcClure, across * across, kernel.scale_m);
  if (!ground) {
    least_squares::add_generalized(sums, lever, error, along, robust * (plane ? kernel.point_weight : kNoPlaneWeight));
  }
  const bool inlier = std::abs(across) < kernel.inlier_m;
  if (plane) {
    Vector6d j;
    j << normal, lever.cross(normal);
    sums.add_row(j, across, robust * (1.0 - kernel.point_weight));
    if (inlier) {
      sums.H_planes.noalias() += j * j.transpose();
    }
  }
  if (inlier) {
    ++sums.inliers;
    sums.structure_inliers += ground ? 0 : 1;
    sums.squares += across * across;
  }
}

MatchEquations linearize(const Keypoints& keypoints, const surfels::LocalMap& map, const Pose& T, double threshold_m,
                         const Kernel& kernel) {
  const Eigen::Matrix3d along = weight_along(T);
  return least_squares::sum_in_blocks<MatchEquations>(
      keypoints.points.size(), kBlock, [&](std::size_t i, MatchEquations& sums) {
        surfels::MapMatch match;
        const Eigen::Vector3d lever = T.linear() * keypoints.points[i].cast<double>();
        const Eigen::Vector3d point = lever + T.translation();
        if (map.nearest(point, threshold_m, match)) {
          add_match(sums, lever, point - match.point, match.normal, kernel, along, keypoints.is_ground(i));
        }
      });
}

/// Where nothing holds the motion, the start does.
void add_position_prior(MatchEquations& sums, const Pose& T, const Pose& T_start) {
  constexpr double kShare = 1e-4;   // of the weight of the matches
  constexpr double kLeverM = 10.0;  // a rotation counts as what it moves at this range
  const double weight = kShare * static_cast<double>(sums.matches);
  least_squares::add_prior(sums, 0, (T.translation() - T_start.translation()).eval(), weight);
  const Eigen::AngleAxisd turned(T.linear() * T_start.linear().transpose());
  least_squares::add_prior(sums, 3, (turned.angle() * turned.axis()).eval(), weight * kLeverM * kLeverM);
}

void step(Pose& T, const Vector6d& xi) {
  T.translation() += xi.head<3>();
  T.linear() = exp_se3((Vector6d() << Eigen::Vector3d::Zero(), xi.tail<3>()).finished()).linear() * T.linear();
}

/// Translations that the planes hardly hold once the rotation is free: small eigenvalues of the Schur complement.
std::vector<Eigen::Vector3d> weak_directions(const Matrix6d& H, std::size_t keypoints, const Pose& T,
                                             double least_share) {
  const Eigen::Matrix3d rotation_part = H.bottomRightCorner<3, 3>() + 1e-9 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d schur =
      H.topLeftCorner<3, 3>() - H.topRightCorner<3, 3>() * rotation_part.inverse() * H.bottomLeftCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(schur);
  std::vector<Eigen::Vector3d> weak;
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()[k] < least_share * static_cast<double>(keypoints)) {
      weak.emplace_back(T.linear().transpose() * eigen.eigenvectors().col(k));
    }
  }
  return weak;
}

/// Covariance of xi in T * exp(xi) (translation and rotation along the lidar's axes). Directions that nothing
/// holds stay at 10 m and 10 degrees.
Matrix6d pose_covariance(const Matrix6d& H, double residual_m, const Pose& T, double scale) {
  constexpr double kLeastNoise = 0.01;
  constexpr double kUnheldMetres = 10.0;
  constexpr double kUnheldRadians = 0.175;
  const double variance = scale * std::pow(std::max(residual_m, kLeastNoise), 2);
  Vector6d prior;
  prior << Eigen::Vector3d::Constant(1.0 / (kUnheldMetres * kUnheldMetres)),
      Eigen::Vector3d::Constant(1.0 / (kUnheldRadians * kUnheldRadians));
  Matrix6d information = H / variance;
  information.diagonal() += prior;
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = T.linear().transpose();
  turn.bottomRightCorner<3, 3>() = T.linear().transpose();
  const Matrix6d covariance = turn * information.ldlt().solve(Matrix6d::Identity()) * turn.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

TrackingStatus judge(const MatchEquations& sums, std::size_t keypoints, const Pose& T, const OdometryOptions& options) {
  TrackingStatus tracking_status;
  tracking_status.keypoints = keypoints;
  tracking_status.inlier_share =
      keypoints > 0 ? static_cast<double>(sums.inliers) / static_cast<double>(keypoints) : 0.0;
  tracking_status.unmapped_share =
      keypoints > 0 ? 1.0 - static_cast<double>(sums.matches) / static_cast<double>(keypoints) : 1.0;
  tracking_status.fit_share =
      sums.matches > 0 ? static_cast<double>(sums.inliers) / static_cast<double>(sums.matches) : 0.0;
  tracking_status.residual_m = sums.inliers > 0 ? std::sqrt(sums.squares / static_cast<double>(sums.inliers)) : 0.0;
  tracking_status.degenerate_directions = weak_directions(sums.H_planes, keypoints, T, options.degenerate_share);
  tracking_status.covariance = pose_covariance(sums.H_planes, tracking_status.residual_m, T, options.covariance_scale);
  tracking_status.tracking = tracking_status.degenerate_directions.empty() ? Tracking::kGood : Tracking::kDegenerate;
  return tracking_status;
}

void count_structure(const MatchEquations& sums, const Keypoints& keypoints, TrackingStatus& tracking_status) {
  if (keypoints.ground.empty()) {
    return;
  }
  tracking_status.structure =
      static_cast<std::size_t>(std::count(keypoints.ground.begin(), keypoints.ground.end(), false));
  tracking_status.structure_share = tracking_status.structure > 0 ? static_cast<double>(sums.structure_inliers) /
                                                                        static_cast<double>(tracking_status.structure)
                                                                  : 0.0;
}

}  // namespace

Alignment align(const Keypoints& keypoints, const surfels::LocalMap& map, const Pose& T_map_lidar, double threshold_m,
                const OdometryOptions& options) {
  Alignment result{T_map_lidar, {}};
  const double inlier_m = kInlierVoxels * map.voxel_m();
  const Kernel kernel{std::max(threshold_m / 3.0, inlier_m), inlier_m, options.point_weight};
  MatchEquations sums;
  const auto step_at = [&](std::size_t) -> std::optional<Vector6d> {
    sums = linearize(keypoints, map, result.T_map_lidar, threshold_m, kernel);
    if (sums.inliers < kFewestInliers) {
      return std::nullopt;
    }
    if (!keypoints.ground.empty()) {
      add_position_prior(sums, result.T_map_lidar, T_map_lidar);
    }
    return sums.step();
  };
  const least_squares::Convergence convergence = least_squares::gauss_newton(
      {options.max_iterations, kConverged}, step_at, [&](const Vector6d& xi) { step(result.T_map_lidar, xi); });
  result.tracking_status = judge(sums, keypoints.points.size() - sums.left_out, result.T_map_lidar, options);
  count_structure(sums, keypoints, result.tracking_status);
  result.tracking_status.iterations = convergence.iterations;
  result.tracking_status.converged = convergence.converged;
  return result;
}

const char* name(Tracking tracking) {
  switch (tracking) {
    case Tracking::kGood:
      return "good";
    case Tracking::kDegenerate:
      return "degenerate";
    case Tracking::kLost:
      break;
  }
  return "lost";
}

}  // namespace loopmark::odometry

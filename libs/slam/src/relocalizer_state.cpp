// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "relocalizer_state.hpp"

#include "loopmark/cloud/voxel.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kBelieved = 4;  ///< places that another scan is asked about, whatever it looks like itself
constexpr double kNearVoxels = 0.4;   ///< distance to a match while the own motion predicts well

}  // namespace

void Relocalizer::State::renew_surroundings(const Eigen::Vector3d& position) {
  if (around && (position - around_at).norm() < options.map_radius_m / 3.0) {
    return;
  }
  around.emplace(odometry.map()->voxel_m(), odometry_options.points_per_voxel);
  around->insert(map->points_around(position, options.map_radius_m));
  around_at = position;
}

void Relocalizer::State::mend_own_motion(const TrackedScan& tracked, const Pose& T_map_lidar, const Pose& predicted) {
  const bool wrong = pose_error(T_map_lidar, predicted).translation_m > kDisagreementM;
  if (wrong && last_in_map && gap_s > 0.0 && gap_s <= kGapS) {
    TrackedScan moving = tracked;
    moving.velocity = log_se3(last_in_map->inverse() * T_map_lidar) / gap_s;
    odometry.restart(tracked.T_map_lidar);
    odometry.commit(moving);
    committed = 1;
  }
  last_in_map = T_map_lidar;
}

std::vector<Pose> Relocalizer::State::believed(const Pose& T_odometry_lidar) const {
  std::vector<Pose> poses;
  for (const PlaceBelief& belief : beliefs.all()) {
    if (poses.size() < kBelieved) {
      poses.push_back(belief.T_map_odometry * T_odometry_lidar);
    }
  }
  return poses;
}

Alignment Relocalizer::State::align_to_map(const PointCloud& cloud, const Pose& predicted) {
  renew_surroundings(predicted.translation());
  std::vector<Eigen::Vector3f> keypoints;
  for (const std::size_t i : voxel_first_indices(cloud.points, odometry_options.keypoint_voxels * around->voxel_m())) {
    keypoints.push_back(cloud.points[i]);
  }
  Alignment near = align(keypoints, *around, predicted, kNearVoxels * around->voxel_m(), odometry_options);
  Alignment wide = align(keypoints, *around, predicted, around->voxel_m(), odometry_options);
  return wide.health.inlier_share > near.health.inlier_share ? wide : near;
}

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "relocalizer_state.hpp"

#include "loopmark/cloud/voxel.hpp"

namespace loopmark::localization {
namespace {

constexpr std::size_t kBelieved = 4;  ///< places that another scan is asked about, whatever it looks like itself
constexpr double kNearVoxels = 0.4;   ///< distance to a match while the own motion predicts well
constexpr double kAsUsual = 0.9;  ///< of the usual share of fitting keypoints: nothing more is to be found farther off

}  // namespace

void Relocalizer::State::renew_surroundings(const Eigen::Vector3d& position) {
  if (around && (position - around_at).norm() < options.map_radius_m / 3.0) {
    return;
  }
  around.emplace(odometry.map()->voxel_m(), odometry_options.points_per_voxel);
  around->insert(map->points_around(position, options.map_radius_m));
  around_at = position;
}

std::optional<internal::SweepInMap> Relocalizer::State::sweep_in_map(const odometry::TrackedScan& tracked,
                                                                     const Pose& near) {
  const PointCloud& sample = tracked.sample;
  if (!odometry.deskews() || sample.time_offset_s.size() != sample.size()) {
    return std::nullopt;
  }
  renew_surroundings(near.translation());
  return internal::align_sweep(sample.points, sample.time_offset_s, *around, near);
}

void Relocalizer::State::begin_odometry(const odometry::TrackedScan& tracked, const Vector6d& velocity) {
  odometry::TrackedScan moving = tracked;
  moving.velocity = moving.sweep_velocity = velocity;
  odometry.restart(tracked.T_map_lidar);
  odometry.commit(moving);
  first_with_motion = std::move(moving);
  committed = 1;
}

void Relocalizer::State::reset_odometry(const odometry::TrackedScan& tracked, const Pose& T_map_lidar,
                                        const Pose& predicted) {
  const bool wrong = pose_error(T_map_lidar, predicted).translation_m > kDisagreementM;
  if (wrong && last_in_map && gap_s > 0.0 && gap_s <= kGapS) {
    begin_odometry(tracked, log_se3(last_in_map->inverse() * T_map_lidar) / gap_s);
  }
  last_in_map = T_map_lidar;
}

std::vector<Pose> Relocalizer::State::priors(const Pose& T_odometry_lidar) const {
  std::vector<Pose> poses;
  for (const PlaceBelief& belief : beliefs.all()) {
    if (poses.size() < kBelieved) {
      poses.push_back(belief.T_map_odometry * T_odometry_lidar);
    }
  }
  return poses;
}

bool Relocalizer::State::doubtful(const Followed& followed) const {
  return followed.tracking_status.inlier_share < options.doubt_share * usual_share || gap_s > kGapS ||
         followed.jump.translation_m > kDisagreementM;
}

bool Relocalizer::State::is_due(const std::optional<Pose>& last, const odometry::TrackedScan& tracked, double after_m) {
  return !last || (last->inverse() * tracked.T_map_lidar).translation().norm() >= after_m;
}

odometry::Alignment Relocalizer::State::align_to_map(const PointCloud& cloud, const Pose& predicted) {
  renew_surroundings(predicted.translation());
  std::vector<Eigen::Vector3f> keypoints;
  for (const std::size_t i :
       cloud::voxel_first_indices(cloud.points, odometry_options.keypoint_voxels * around->voxel_m())) {
    keypoints.push_back(cloud.points[i]);
  }
  odometry::Alignment near =
      odometry::align(keypoints, *around, predicted, kNearVoxels * around->voxel_m(), odometry_options);
  if (usual_share > 0.0 && near.tracking_status.inlier_share >= kAsUsual * usual_share) {
    return near;
  }
  odometry::Alignment wide = odometry::align(keypoints, *around, predicted, around->voxel_m(), odometry_options);
  return wide.tracking_status.inlier_share > near.tracking_status.inlier_share ? wide : near;
}

}  // namespace loopmark::localization

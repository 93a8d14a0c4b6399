// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/odometry/alignment.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kLeastPoints = 100;  ///< of a scan that can be used
constexpr double kFitOdds = 0.5;           ///< added to the log-odds of a place by a scan that fits the map there
constexpr double kMisfitOdds = 1.5;        ///< and taken away by one that does not
constexpr double kMaxLogOdds = 9.0;

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace

const char* name(RelocalizationState state) {
  switch (state) {
    case RelocalizationState::kSearching:
      return "searching";
    case RelocalizationState::kTracking:
      return "tracking";
    case RelocalizationState::kLost:
      break;
  }
  return "lost";
}

void check(const RelocalizationOptions& o) {
  require_option(o.places >= 1, "places", "must be at least 1");
  require_option(o.place_radius_m > 0.0, "place_radius_m", "must be positive");
  require_option(o.min_p_correct > 0.0 && o.min_p_correct < 1.0, "min_p_correct", "must be above 0, below 1");
  require_option(o.tracking_p >= o.min_p_correct && o.tracking_p < 1.0, "tracking_p", "must be min_p_correct to 1");
  require_option(o.same_place_m > 0.0 && o.same_place_deg > 0.0, "same_place_m", "must be positive");
  require_option(o.miss_odds > 0.0 && o.miss_odds <= 1.0, "miss_odds", "must be above 0, at most 1");
  require_option(o.map_radius_m > 0.0, "map_radius_m", "must be positive");
  require_option(o.lost_after >= 1, "lost_after", "must be at least 1");
}

struct Relocalizer::State {
  State(std::shared_ptr<const PlaceMap> m, const RelocalizationOptions& o, const OdometryOptions& odometry_o,
        Compensation compensation, const SweepModel& sweep)
      : map(std::move(m)),
        options(o),
        odometry_options(odometry_o),
        odometry(odometry_o, compensation, sweep),
        beliefs(o) {}

  std::shared_ptr<const PlaceMap> map;
  RelocalizationOptions options;
  OdometryOptions odometry_options;
  Odometry odometry;
  std::size_t committed = 0;

  PlaceBeliefs beliefs;             ///< while searching
  std::optional<Pose> searched_at;  ///< T_odometry_lidar of the scan that was registered last

  bool tracking = false;
  Pose T_map_odometry = Pose::Identity();
  double log_odds = 0.0;
  std::size_t misfits = 0;         ///< in a row
  std::optional<LocalMap> around;  ///< the map around the sensor
  Eigen::Vector3d around_at = Eigen::Vector3d::Zero();

  void renew_surroundings(const Eigen::Vector3d& position);
};

void Relocalizer::State::renew_surroundings(const Eigen::Vector3d& position) {
  if (around && (position - around_at).norm() < options.map_radius_m / 3.0) {
    return;
  }
  around.emplace(odometry.map()->voxel_m(), odometry_options.points_per_voxel);
  around->insert(map->points_around(position, options.map_radius_m));
  around_at = position;
}

Relocalizer::Relocalizer(std::shared_ptr<const PlaceMap> map, const RelocalizationOptions& options,
                         const OdometryOptions& odometry_options, Compensation compensation, const SweepModel& sweep) {
  check(options);
  state_ = std::make_unique<State>(std::move(map), options, odometry_options, compensation, sweep);
}

Relocalizer::~Relocalizer() = default;

RelocalizedScan Relocalizer::add(const Scan& scan) {
  State& s = *state_;
  RelocalizedScan answer;
  answer.scan = scan.index;
  answer.stamp_s = scan.stamp_s;
  TrackedScan tracked = s.odometry.track(scan);
  if (tracked.sample.size() < kLeastPoints) {
    answer.state = s.tracking ? RelocalizationState::kTracking : RelocalizationState::kSearching;
    answer.reason = "the scan has too few points";
    return answer;
  }
  const bool own_motion_lost = s.committed > 0 && tracked.health.tracking == Tracking::kLost;
  if (own_motion_lost) {
    const std::string reason = "the motion was lost: " + tracked.health.reason;
    s.odometry.restart();
    tracked = s.odometry.track(scan);
    s.committed = 0;
    lose(reason, answer);
  }
  s.odometry.commit(tracked);
  ++s.committed;
  if (s.tracking) {
    track(tracked, answer);
  } else {
    search(scan, tracked, answer);
    answer.state = own_motion_lost && !s.tracking ? RelocalizationState::kLost : answer.state;
  }
  return answer;
}

/// Registers the scan to the places that look like it, unless it hardly differs from the one before.
void Relocalizer::search(const Scan& scan, const TrackedScan& tracked, RelocalizedScan& answer) {
  State& s = *state_;
  const Pose& T_odometry_lidar = tracked.T_map_lidar;
  const bool moved =
      !s.searched_at || (s.searched_at->inverse() * T_odometry_lidar).translation().norm() >= s.options.search_every_m;
  if (moved) {
    const PointCloud cloud = s.odometry.deskewed_cloud(scan, tracked.velocity);
    s.beliefs.add(s.map->search(cloud, s.options.places), T_odometry_lidar);
    s.searched_at = T_odometry_lidar;
  }
  const std::optional<PlaceBelief> best = s.beliefs.best();
  answer.state = RelocalizationState::kSearching;
  answer.p_correct = best ? best->p : 0.0;
  if (!best || best->p < s.options.min_p_correct) {
    answer.reason =
        answer.reason.empty() ? (best ? "no place is probable enough" : "no place looks like this") : answer.reason;
    return;
  }
  answer.answered = true;
  answer.T_map_lidar = best->T_map_odometry * T_odometry_lidar;
  answer.covariance = best->covariance;
  if (best->p >= s.options.tracking_p) {
    s.tracking = true;
    s.T_map_odometry = best->T_map_odometry;
    s.log_odds = best->log_odds;
    s.misfits = 0;
    s.around.reset();
    track(tracked, answer);
  }
}

/// Aligns the scan to the map from where the own motion predicts it.
void Relocalizer::track(const TrackedScan& tracked, RelocalizedScan& answer) {
  State& s = *state_;
  const Pose predicted = s.T_map_odometry * tracked.T_map_lidar;
  s.renew_surroundings(predicted.translation());
  std::vector<Eigen::Vector3f> keypoints;
  for (const std::size_t i :
       voxel_first_indices(tracked.sample.points, s.odometry_options.keypoint_voxels * s.around->voxel_m())) {
    keypoints.push_back(tracked.sample.points[i]);
  }
  const Alignment found = align(keypoints, *s.around, predicted, s.around->voxel_m(), s.odometry_options);
  const PoseError jump = pose_error(found.T_map_lidar, predicted);
  const bool fits = found.health.inlier_share >= s.options.min_inlier_share &&
                    jump.translation_m <= s.options.max_jump_m && jump.rotation_deg <= s.options.same_place_deg;
  s.misfits = fits ? 0 : s.misfits + 1;
  s.log_odds = fits ? std::min(s.log_odds + kFitOdds, kMaxLogOdds) : s.log_odds - kMisfitOdds;
  const Pose T_map_lidar = fits ? found.T_map_lidar : predicted;
  if (fits) {
    s.T_map_odometry = T_map_lidar * tracked.T_map_lidar.inverse();
  }
  answer.inlier_share = found.health.inlier_share;
  answer.p_correct = probability(s.log_odds);
  if (s.misfits >= s.options.lost_after || answer.p_correct < s.options.min_p_correct) {
    lose("scans no longer fit the map", answer);
    return;
  }
  answer.state = RelocalizationState::kTracking;
  answer.answered = true;
  answer.T_map_lidar = T_map_lidar;
  const Matrix6d to_map = adjoint(T_map_lidar);
  answer.covariance = to_map * found.health.covariance * to_map.transpose();
}

void Relocalizer::lose(const std::string& reason, RelocalizedScan& answer) {
  State& s = *state_;
  s.tracking = false;
  s.beliefs.clear();
  s.searched_at.reset();
  answer.state = RelocalizationState::kLost;
  answer.answered = false;
  answer.reason = reason;
}

}  // namespace loopmark

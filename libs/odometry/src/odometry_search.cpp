// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Where the odometry looks for a scan, and which of the answers it takes.
#include "odometry_search.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/parallel.hpp"

namespace loopmark::odometry {
namespace {

bool better(const TrackingStatus& a, const TrackingStatus& b) { return a.inlier_share > b.inlier_share; }

/// What of a scan fits: of its structure, where that was told apart from the ground.
double share_that_fits(const TrackingStatus& tracking_status) {
  return tracking_status.structure >= kLeastStructure ? tracking_status.structure_share : tracking_status.inlier_share;
}

/// The rings of the ground fit best where the sensor stands; what rises from it tells. Without it, that nothing holds a
/// direction tells against an answer.
bool better_initialising(const TrackingStatus& a, const TrackingStatus& b) {
  constexpr double kUnheld = 0.8;
  const auto score = [](const TrackingStatus& tracking_status) {
    const bool unheld = tracking_status.structure < kLeastStructure && !tracking_status.degenerate_directions.empty();
    return share_that_fits(tracking_status) * (unheld ? kUnheld : 1.0);
  };
  return score(a) > score(b);
}

bool same_place(const Pose& a, const Pose& b, double distance_m) {
  constexpr double kSameDegrees = 5.0;
  const PoseError error = pose_error(a, b);
  return error.translation_m < distance_m && error.rotation_deg < kSameDegrees;
}

}  // namespace

bool even(double gap_s, double last_gap_s) {
  constexpr double kMostUneven = 1.5;
  const auto [least, most] = std::minmax(gap_s, last_gap_s);
  return most <= kUsualGapS && most <= kMostUneven * least;
}

std::vector<Pose> straight_motions(const std::vector<double>& distances_m) {
  std::vector<Pose> result;
  for (const double distance_m : distances_m) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double heading = quarter * M_PI / 2.0;
      result.push_back(pose_from_yaw(0.0, distance_m * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0)));
    }
  }
  return result;
}

std::vector<Odometry::Start> Odometry::starts(double stamp_s) const {
  const double gap_s = gap_to(stamp_s);
  const auto after = [&](double share) {
    return Start{last_->T_map_lidar * exp_se3(share * gap_s * last_->velocity), share * last_->velocity};
  };
  std::vector<Start> result = {after(1.0)};
  if (!even(gap_s, last_gap_s_)) {  // it may have slowed down or stopped in between, or the stamp is wrong
    result.push_back(after(0.0));
    result.push_back(after(0.5));
  }
  return result;
}

/// Around the last pose: a log may start while moving, a hand-held sensor may turn in any way, scans may be missing.
std::vector<Odometry::Start> Odometry::wide_starts(double stamp_s) const {
  constexpr int kTurns = 24;
  const double gap_s = gap_to(stamp_s);
  std::vector<Start> result = starts(stamp_s);
  const auto add = [&](const Pose& T_last_lidar) {
    result.push_back({last_->T_map_lidar * T_last_lidar, log_se3(T_last_lidar) / gap_s});
  };
  for (int turn = 0; turn < kTurns; ++turn) {
    add(pose_from_yaw(2.0 * M_PI * turn / kTurns));
  }
  std::vector<double> distances_m = {0.7, 1.4, 2.1, 2.8, 3.5, 5.0, 7.0, 10.0, 14.0};
  std::erase_if(distances_m, [&](double distance_m) { return distance_m > kFastest * gap_s; });
  for (const Pose& T_last_lidar : straight_motions(distances_m)) {
    add(T_last_lidar);
  }
  return result;
}

void Odometry::align_from(TrackedScan& tracked, const Start& start, double threshold_m) const {
  align_to(*map_, tracked, start, threshold_m);
}

void Odometry::align_to(const surfels::LocalMap& map, TrackedScan& tracked, const Start& start,
                        double threshold_m) const {
  tracked.T_map_lidar = start.T_map_lidar;
  tracked.velocity = start.velocity;
  tracked.sweep_velocity = start.velocity;
  const double gap_s = gap_to(tracked.stamp_s);
  const int rounds = deskews() ? 2 : 1;  // the second with the velocity that the first has found
  for (int round = 0; round < rounds; ++round) {
    const Alignment found = align(keypoints(tracked, options_.keypoint_voxels * map.voxel_m()), map,
                                  tracked.T_map_lidar, threshold_m, options_);
    tracked.T_map_lidar = found.T_map_lidar;
    tracked.tracking_status = found.tracking_status;
    if (!initialising(tracked.stamp_s)) {
      tracked.tracking_status.structure = 0;
    }
    tracked.velocity = log_se3(last_->T_map_lidar.inverse() * tracked.T_map_lidar) / gap_s;
    tracked.sweep_velocity = during_sweep(tracked);
  }
}

/// The best few of many starts, distinct, by a quick alignment to the coarse map.
std::vector<Odometry::Start> Odometry::shortlist(const TrackedScan& prepared, const std::vector<Start>& starts) const {
  constexpr std::size_t kKept = 4;
  OdometryOptions quick = options_;
  quick.max_iterations = 12;
  const Keypoints points = keypoints(prepared, coarse_->voxel_m());
  std::vector<Alignment> found(starts.size());
  parallel_for(starts.size(), [&](std::size_t i) {
    found[i] = align(points, *coarse_, starts[i].T_map_lidar, coarse_->voxel_m(), quick);
  });
  std::stable_sort(found.begin(), found.end(),
                   [](const Alignment& a, const Alignment& b) { return better(a.tracking_status, b.tracking_status); });
  std::vector<Start> kept;
  for (const Alignment& candidate : found) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Start& start) {
      return same_place(start.T_map_lidar, candidate.T_map_lidar, coarse_->voxel_m());
    });
    if (!known && kept.size() < kKept) {
      kept.push_back({candidate.T_map_lidar, Vector6d::Zero()});
    }
  }
  return kept;
}

TrackedScan Odometry::best_of(const TrackedScan& prepared, const std::vector<Start>& starts, double threshold_m) const {
  const auto ahead = initialising(prepared.stamp_s) ? better_initialising : better;
  std::optional<TrackedScan> best;
  for (const Start& start : starts) {
    TrackedScan tracked = prepared;
    align_from(tracked, start, threshold_m);
    if (!best || ahead(tracked.tracking_status, best->tracking_status)) {
      best = std::move(tracked);
    }
  }
  judge(*best);
  return *best;
}

TrackedScan Odometry::best_of_wide(const TrackedScan& prepared, const TrackedScan& near) const {
  std::vector<TrackedScan> answers = {near};
  for (const Start& start : shortlist(prepared, wide_starts(prepared.stamp_s))) {
    answers.push_back(prepared);
    align_from(answers.back(), start, map_->voxel_m());
  }
  if (committed_ == 1 && initialising(prepared.stamp_s)) {
    for (const Start& start : straight_starts(prepared)) {
      answers.push_back(prepared);
      align_from(answers.back(), start, map_->voxel_m());
    }
  }
  if (committed_ == 1 && deskews()) {
    for (TrackedScan& answer : answers) {
      align_to_deskewed_first(answer);
    }
  }
  const bool doubtful = committed_ == 1 || initialising(prepared.stamp_s);
  const auto ahead = doubtful ? better_initialising : better;
  std::stable_sort(answers.begin(), answers.end(), [&](const TrackedScan& a, const TrackedScan& b) {
    return ahead(a.tracking_status, b.tracking_status);
  });
  TrackedScan& best = answers.front();
  for (const TrackedScan& other : answers) {
    if (!same_place(other.T_map_lidar, best.T_map_lidar, map_->voxel_m())) {
      best.tracking_status.margin =
          share_that_fits(best.tracking_status) / std::max(share_that_fits(other.tracking_status), 1e-3);
      break;
    }
  }
  judge(best);
  return best;
}

/// The first scan of a segment was taken in before any motion was known. Deskewed by the motion of `answer` it is
/// sharp if that is right; without this, standing still would fit best, as the rings of the ground do not move.
void Odometry::align_to_deskewed_first(TrackedScan& answer) const {
  TrackedScan first = *last_;
  first.sweep_velocity = answer.velocity;
  surfels::LocalMap map(map_->voxel_m(), options_.points_per_voxel);
  map.insert(in_map(first));
  align_to(map, answer, {answer.T_map_lidar, answer.velocity}, map.voxel_m());
}

}  // namespace loopmark::odometry

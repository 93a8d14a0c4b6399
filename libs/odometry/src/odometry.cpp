// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/features/ground.hpp"

namespace loopmark {
namespace {

constexpr double kSampleVoxels = 0.5;  // points for the map: one in a cell of this many voxels
constexpr double kCoarse = 3.0;        // voxel of the coarse map against the fine one's
constexpr double kLeverM = 20.0;       // a rotation error counts as what it moves at this range
constexpr std::size_t kMemory = 20;    // deviations that the threshold remembers
constexpr double kUsualGapS = 0.2;     // longer gaps between scans make the prediction less certain

std::vector<std::size_t> in_range(const std::vector<Eigen::Vector3f>& points, const OdometryOptions& options) {
  const auto least = static_cast<float>(options.min_range_m * options.min_range_m);
  const auto most = static_cast<float>(options.max_range_m * options.max_range_m);
  std::vector<std::size_t> kept;
  kept.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float range = points[i].squaredNorm();  // NaN fails both comparisons
    if (range > least && range < most) {
      kept.push_back(i);
    }
  }
  return kept;
}

double deviation_m(const Pose& predicted, const Pose& found) {
  const PoseError error = pose_error(found, predicted);
  return error.translation_m + 2.0 * std::sin(error.rotation_deg * M_PI / 360.0) * kLeverM;
}

std::vector<Eigen::Vector3d> moved(const std::vector<Eigen::Vector3f>& points, const Pose& T) {
  std::vector<Eigen::Vector3d> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(),
                 [&](const Eigen::Vector3f& p) { return T * p.cast<double>(); });
  return result;
}

bool better(const Health& a, const Health& b) { return a.inlier_share > b.inlier_share; }

/// At the start of a piece: rings of the ground that fit while nothing holds a direction are no evidence of standing.
bool better_start(const Health& a, const Health& b) {
  constexpr double kUnheld = 0.8;
  const auto score = [](const Health& health) {
    return health.inlier_share * (health.degenerate_directions.empty() ? 1.0 : kUnheld);
  };
  return score(a) > score(b);
}

bool same_place(const Pose& a, const Pose& b, double distance_m) {
  constexpr double kSameDegrees = 5.0;
  const PoseError error = pose_error(a, b);
  return error.translation_m < distance_m && error.rotation_deg < kSameDegrees;
}

}  // namespace

/// A guess of where the scan is; how its motion follows from the last scan unless the guess says otherwise.
struct Odometry::Start {
  Pose T_map_lidar;
  Vector6d velocity;
};

void check(const OdometryOptions& o) {
  require_option(o.min_range_m >= 0.0 && o.max_range_m > o.min_range_m, "max_range_m", "must exceed min_range_m >= 0");
  require_option(o.voxel_m >= 0.0, "voxel_m", "must not be negative");
  require_option(o.points_per_voxel >= 1 && o.points_per_voxel <= LocalMap::kMaxPoints, "points_per_voxel",
                 "must be 1 to " + std::to_string(LocalMap::kMaxPoints));
  require_option(o.keypoint_voxels > 0.0, "keypoint_voxels", "must be positive");
  require_option(o.max_iterations >= 1, "max_iterations", "must be at least 1");
  require_option(o.min_threshold_m > 0.0 && o.first_threshold_m >= o.min_threshold_m, "first_threshold_m",
                 "must be at least min_threshold_m > 0");
  require_option(o.point_weight >= 0.0 && o.point_weight <= 1.0, "point_weight", "must be 0 to 1");
}

Odometry::Odometry(const OdometryOptions& options, Compensation compensation, const SweepModel& sweep)
    : options_(options), compensation_(compensation), sweep_(sweep), last_gap_s_(sweep.period_s) {
  check(options_);
  sweep_.clockwise = compensation != Compensation::kRawCounterClockwise;
}

bool Odometry::deskews() const {
  return compensation_ == Compensation::kRawGivenTimes || compensation_ == Compensation::kRawClockwise ||
         compensation_ == Compensation::kRawCounterClockwise;
}

std::vector<float> Odometry::times(const PointCloud& cloud) const {
  if (compensation_ == Compensation::kRawGivenTimes) {
    return cloud.time_offset_s;
  }
  return times_from_azimuth(cloud.points, sweep_);
}

TrackedScan Odometry::prepare(const Scan& scan) const {
  TrackedScan tracked;
  tracked.index = scan.index;
  tracked.stamp_s = scan.stamp_s;
  PointCloud thin;
  const bool timed = deskews() && scan.cloud.time_offset_s.size() == scan.cloud.size();
  for (const std::size_t i : in_range(scan.cloud.points, options_)) {
    thin.points.push_back(scan.cloud.points[i]);
    if (timed) {
      thin.time_offset_s.push_back(scan.cloud.time_offset_s[i]);
    }
  }
  const double voxel_m = map_                     ? map_->voxel_m()
                         : options_.voxel_m > 0.0 ? options_.voxel_m
                                                  : voxel_for_scene(thin.points);
  tracked.sample = select(thin, voxel_first_indices(thin.points, kSampleVoxels * voxel_m));
  if (deskews()) {
    tracked.sample.time_offset_s = times(tracked.sample);
  }
  return tracked;
}

std::vector<Eigen::Vector3f> Odometry::deskewed_sample(const TrackedScan& tracked) const {
  return deskews() ? deskewed(tracked.sample.points, tracked.sample.time_offset_s, tracked.velocity)
                   : tracked.sample.points;
}

/// Seconds since the last scan. Stamps that repeat or go back say nothing: then it was as long as before.
double Odometry::gap_to(double stamp_s) const {
  const double gap_s = stamp_s - last_->stamp_s;
  return gap_s > 0.0 ? gap_s : last_gap_s_;
}

std::vector<Odometry::Start> Odometry::starts(double stamp_s) const {
  const double gap_s = gap_to(stamp_s);
  const auto after = [&](double share) {
    return Start{last_->T_map_lidar * exp_se3(share * gap_s * last_->velocity), share * last_->velocity};
  };
  std::vector<Start> result = {after(1.0)};
  if (gap_s > kUsualGapS) {  // it may have slowed down or stopped in between
    result.push_back(after(0.0));
    result.push_back(after(0.5));
  }
  return result;
}

/// Around the last pose: a log may start while moving, a hand-held sensor may turn in any way, scans may be missing.
std::vector<Odometry::Start> Odometry::wide_starts(double stamp_s) const {
  constexpr double kFastest = 35.0;  // m/s
  constexpr int kTurns = 24;
  const double gap_s = gap_to(stamp_s);
  std::vector<Start> result = starts(stamp_s);
  const auto add = [&](const Pose& T_last_lidar) {
    result.push_back({last_->T_map_lidar * T_last_lidar, log_se3(T_last_lidar) / gap_s});
  };
  for (int turn = 0; turn < kTurns; ++turn) {
    add(pose_from_yaw(2.0 * M_PI * turn / kTurns));
  }
  for (const double distance : {0.7, 1.4, 2.1, 2.8, 3.5, 5.0, 7.0, 10.0, 14.0}) {
    if (distance <= kFastest * gap_s) {
      for (int quarter = 0; quarter < 4; ++quarter) {
        const double heading = quarter * M_PI / 2.0;
        add(pose_from_yaw(0.0, distance * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0)));
      }
    }
  }
  return result;
}

void Odometry::align_from(TrackedScan& tracked, const Start& start, double threshold_m) const {
  align_to(*map_, tracked, start, threshold_m);
}

void Odometry::align_to(const LocalMap& map, TrackedScan& tracked, const Start& start, double threshold_m) const {
  tracked.T_map_lidar = start.T_map_lidar;
  tracked.velocity = start.velocity;
  const double gap_s = gap_to(tracked.stamp_s);
  const int rounds = deskews() ? 2 : 1;  // the second with the velocity that the first has found
  for (int round = 0; round < rounds; ++round) {
    const Alignment found = align(keypoints(tracked, options_.keypoint_voxels * map.voxel_m()), map,
                                  tracked.T_map_lidar, threshold_m, options_);
    tracked.T_map_lidar = found.T_map_lidar;
    tracked.health = found.health;
    tracked.velocity = log_se3(last_->T_map_lidar.inverse() * tracked.T_map_lidar) / gap_s;
  }
}

Keypoints Odometry::keypoints(const TrackedScan& tracked, double cell_m) const {
  const std::vector<Eigen::Vector3f> points = deskewed_sample(tracked);
  Keypoints result;
  for (const std::size_t i : voxel_first_indices(points, cell_m)) {
    result.points.push_back(points[i]);
  }
  if (committed_ == 1) {  // before any motion is known, rings on the ground must not say that there is none
    result.ground = ground_points(result.points, {});
  }
  return result;
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
                   [](const Alignment& a, const Alignment& b) { return better(a.health, b.health); });
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

double Odometry::threshold(double gap_s) const {
  if (deviations_.size() < 3) {
    return options_.first_threshold_m * (map_->voxel_m() < 1.0 ? map_->voxel_m() : 1.0);
  }
  double squares = 0.0;
  for (const double d : deviations_) {
    squares += d * d;
  }
  const double usual = 3.0 * std::sqrt(squares / static_cast<double>(deviations_.size()));
  return std::clamp(usual * std::max(1.0, gap_s / kUsualGapS), options_.min_threshold_m * map_->voxel_m(),
                    map_->voxel_m());
}

TrackedScan Odometry::track(const Scan& scan) const {
  TrackedScan tracked = prepare(scan);
  if (!last_) {
    tracked.T_map_lidar = origin_;
    tracked.health.tracking = Tracking::kGood;
    tracked.health.keypoints = tracked.sample.size();
    return tracked;
  }
  const double threshold_m = threshold(gap_to(tracked.stamp_s));
  TrackedScan near = best_of(tracked, starts(scan.stamp_s), threshold_m);
  if (committed_ > 1 && near.health.tracking != Tracking::kLost) {
    return near;
  }
  return best_of_wide(tracked, near);
}

TrackedScan Odometry::best_of(const TrackedScan& prepared, const std::vector<Start>& starts, double threshold_m) const {
  std::optional<TrackedScan> best;
  for (const Start& start : starts) {
    TrackedScan tracked = prepared;
    align_from(tracked, start, threshold_m);
    if (!best || better(tracked.health, best->health)) {
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
  if (committed_ == 1 && deskews()) {
    for (TrackedScan& answer : answers) {
      align_to_deskewed_first(answer);
    }
  }
  const auto ahead = committed_ == 1 ? better_start : better;
  std::stable_sort(answers.begin(), answers.end(),
                   [&](const TrackedScan& a, const TrackedScan& b) { return ahead(a.health, b.health); });
  TrackedScan& best = answers.front();
  for (const TrackedScan& other : answers) {
    if (!same_place(other.T_map_lidar, best.T_map_lidar, map_->voxel_m())) {
      best.health.margin = best.health.inlier_share / std::max(other.health.inlier_share, 1e-3);
      break;
    }
  }
  judge(best);
  return best;
}

TrackedScan Odometry::track_from(const Scan& scan, const Pose& T_map_lidar) const {
  TrackedScan tracked = prepare(scan);
  if (!last_) {
    tracked.T_map_lidar = T_map_lidar;
    return tracked;
  }
  const Vector6d velocity = log_se3(last_->T_map_lidar.inverse() * T_map_lidar) / gap_to(scan.stamp_s);
  align_from(tracked, {T_map_lidar, velocity}, map_->voxel_m());
  judge(tracked);
  return tracked;
}

/// The first scan of a piece was taken in before any motion was known. Deskewed by the motion of `answer` it is
/// sharp if that is right; without this, standing still would fit best, as the rings of the ground do not move.
void Odometry::align_to_deskewed_first(TrackedScan& answer) const {
  TrackedScan first = *last_;
  first.velocity = answer.velocity;
  LocalMap map(map_->voxel_m(), options_.points_per_voxel);
  map.insert(moved(deskewed_sample(first), first.T_map_lidar));
  align_to(map, answer, {answer.T_map_lidar, answer.velocity}, map.voxel_m());
}

void Odometry::judge(TrackedScan& tracked) const {
  const double gap_s = gap_to(tracked.stamp_s);
  const Vector6d change = tracked.velocity - last_->velocity;
  Health& health = tracked.health;
  health.tracking = health.degenerate_directions.empty() ? Tracking::kGood : Tracking::kDegenerate;
  health.reason.clear();
  const bool doubtful = health.inlier_share < options_.min_inlier_share;
  if (doubtful && health.margin < options_.min_margin) {
    health.tracking = Tracking::kLost;
    health.reason = "few points fit the map, and elsewhere hardly fewer";
  } else if (committed_ > 1 && change.head<3>().norm() > options_.max_acceleration * std::max(gap_s, 0.1)) {
    health.tracking = Tracking::kLost;
    health.reason = "the motion jumps";
  }
}

void Odometry::commit(const TrackedScan& tracked) {
  if (!map_) {
    const double voxel_m = options_.voxel_m > 0.0 ? options_.voxel_m : voxel_for_scene(tracked.sample.points);
    map_.emplace(voxel_m, options_.points_per_voxel);
    coarse_.emplace(kCoarse * voxel_m, options_.points_per_voxel);
    swept_at_ = tracked.T_map_lidar.translation();
  }
  if (last_) {
    const double gap_s = gap_to(tracked.stamp_s);
    const Pose predicted = last_->T_map_lidar * exp_se3(gap_s * last_->velocity);
    last_gap_s_ = gap_s;
    if (committed_ > 1) {
      deviations_.push_back(deviation_m(predicted, tracked.T_map_lidar));
    }
    if (deviations_.size() > kMemory) {
      deviations_.pop_front();
    }
    if (committed_ == 1 && deskews()) {
      last_->velocity = tracked.velocity;
      rebuild_first_scan();
    }
  }
  grow(tracked);
  constexpr double kPruneEveryM = 10.0;
  if ((tracked.T_map_lidar.translation() - swept_at_).norm() > kPruneEveryM) {
    swept_at_ = tracked.T_map_lidar.translation();
    map_->forget_beyond(swept_at_, options_.max_range_m);
    coarse_->forget_beyond(swept_at_, options_.max_range_m);
  }
  last_ = tracked;
  ++committed_;
}

void Odometry::grow(const TrackedScan& tracked) {
  const std::vector<Eigen::Vector3d> points = moved(deskewed_sample(tracked), tracked.T_map_lidar);
  map_->insert(points);
  coarse_->insert(points);
}

void Odometry::rebuild_first_scan() {
  map_.emplace(map_->voxel_m(), options_.points_per_voxel);
  coarse_.emplace(coarse_->voxel_m(), options_.points_per_voxel);
  grow(*last_);
}

void Odometry::restart(const Pose& T_map_lidar) {
  origin_ = T_map_lidar;
  map_.reset();
  coarse_.reset();
  last_.reset();
  deviations_.clear();
  last_gap_s_ = sweep_.period_s;
  committed_ = 0;
}

PointCloud Odometry::deskewed_cloud(const Scan& scan, const Vector6d& velocity) const {
  PointCloud cloud = select(scan.cloud, in_range(scan.cloud.points, options_));
  if (deskews()) {
    cloud.points = deskewed(cloud.points, times(cloud), velocity);
  }
  return cloud;
}

double voxel_for_scene(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kVoxelsAcross = 15.0;
  constexpr double kLeast = 0.3;
  constexpr double kMost = 1.0;
  if (points.empty()) {
    return kMost;
  }
  std::vector<float> ranges(points.size());
  std::transform(points.begin(), points.end(), ranges.begin(), [](const Eigen::Vector3f& p) { return p.norm(); });
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() * 9 / 10);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return std::clamp(static_cast<double>(*middle) / kVoxelsAcross, kLeast, kMost);
}

}  // namespace loopmark

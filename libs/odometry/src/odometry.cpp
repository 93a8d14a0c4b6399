// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "odometry_search.hpp"

namespace loopmark::odometry {
namespace {

constexpr double kCoarse = 3.0;          // voxel of the coarse map against the fine one's
constexpr double kLeverM = 20.0;         // a rotation error counts as what it moves at this range
constexpr double kStructureShare = 0.5;  // of what rises from the ground, less needs to fit: this of min_inlier_share
constexpr std::size_t kMemory = 20;      // deviations that the threshold remembers

double deviation_m(const Pose& predicted, const Pose& found) {
  const PoseError error = pose_error(found, predicted);
  return error.translation_m + 2.0 * std::sin(error.rotation_deg * M_PI / 360.0) * kLeverM;
}

}  // namespace

Odometry::Odometry(const OdometryOptions& options, Compensation compensation, const cloud::SweepModel& sweep)
    : options_(options), compensation_(compensation), sweep_(sweep), last_gap_s_(sweep.period_s) {
  check(options_);
  sweep_.clockwise = compensation != Compensation::kRawCounterClockwise;
}

/// Seconds since the last scan. Stamps that repeat or go back say nothing: then it was as long as before.
double Odometry::gap_to(double stamp_s) const {
  const double gap_s = stamp_s - last_->stamp_s;
  return gap_s > 0.0 ? gap_s : last_gap_s_;
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
    tracked.tracking_status.tracking = Tracking::kGood;
    tracked.tracking_status.keypoints = tracked.sample.size();
    return tracked;
  }
  const double threshold_m = threshold(gap_to(tracked.stamp_s));
  TrackedScan near = best_of(tracked, starts(scan.stamp_s), threshold_m);
  if (committed_ > 1 && near.tracking_status.tracking != Tracking::kLost) {
    return near;
  }
  return best_of_wide(tracked, near);
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

void Odometry::judge(TrackedScan& tracked) const {
  const double gap_s = gap_to(tracked.stamp_s);
  const Vector6d change = tracked.velocity - last_->velocity;
  TrackingStatus& tracking_status = tracked.tracking_status;
  tracking_status.tracking = tracking_status.degenerate_directions.empty() ? Tracking::kGood : Tracking::kDegenerate;
  tracking_status.reason.clear();
  const bool by_structure = tracking_status.structure >= kLeastStructure;
  const bool doubtful = by_structure ? tracking_status.structure_share < kStructureShare * options_.min_inlier_share
                                     : tracking_status.inlier_share < options_.min_inlier_share;
  tracking_status.few_fit = doubtful;
  if (doubtful && tracking_status.margin < options_.min_margin) {
    tracking_status.tracking = Tracking::kLost;
    tracking_status.reason = "few points fit the map, and elsewhere hardly fewer";
  } else if (committed_ > 1 && change.head<3>().norm() > options_.max_acceleration * std::max(gap_s, 0.1)) {
    tracking_status.tracking = Tracking::kLost;
    tracking_status.reason = "the motion jumps";
  }
}

void Odometry::commit(const TrackedScan& tracked) {
  if (!map_) {
    begin_map(tracked);
  }
  if (last_) {
    learn_motion(tracked);
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

void Odometry::begin_map(const TrackedScan& first) {
  const double voxel_m = options_.voxel_m > 0.0 ? options_.voxel_m : voxel_for_scene(first.sample.points);
  map_.emplace(voxel_m, options_.points_per_voxel);
  coarse_.emplace(kCoarse * voxel_m, options_.points_per_voxel);
  swept_at_ = first.T_map_lidar.translation();
}

/// How far the prediction missed; the second scan of a segment tells how the sensor moved while it took the first.
void Odometry::learn_motion(const TrackedScan& tracked) {
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
    last_->velocity = last_->sweep_velocity = tracked.velocity;
    rebuild_first_scan();
  }
}

void Odometry::grow(const TrackedScan& tracked) {
  const std::vector<Eigen::Vector3d> points = in_map(tracked);
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

}  // namespace loopmark::odometry

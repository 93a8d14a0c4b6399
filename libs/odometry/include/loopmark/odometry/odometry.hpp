// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Odometry of one segment of a drive: each scan is aligned to a local map of the scans before it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/cloud/deskew.hpp"
#include "loopmark/core/point_cloud.hpp"
#include "loopmark/odometry/alignment.hpp"
#include "loopmark/odometry/options.hpp"
#include "loopmark/odometry/tracking_status.hpp"
#include "loopmark/surfels/local_map.hpp"

namespace loopmark::odometry {

/// A scan with a pose, not yet part of the local map.
struct TrackedScan {
  std::size_t index = 0;
  double stamp_s = 0.0;
  Pose T_map_lidar = Pose::Identity();         ///< at the scan's stamp
  Vector6d velocity = Vector6d::Zero();        ///< mean since the last scan, in the lidar's frame, a second
  Vector6d sweep_velocity = Vector6d::Zero();  ///< during the sweep: what the scan was deskewed with
  TrackingStatus tracking_status;
  PointCloud sample;  ///< its points, thinned, as seen (not deskewed), with times where known
};

/// The front end. Feed scans in order: `track` finds the pose, `commit` accepts it and grows the map. A caller that
/// knows better (global registration, another sensor) may change the pose in between, or `restart`.
class Odometry {
 public:
  /// `compensation`: whether and how scans are deskewed; `sweep`: for logs without times (its direction is set
  /// from `compensation`).
  explicit Odometry(const OdometryOptions& options, Compensation compensation = Compensation::kUnknown,
                    const cloud::SweepModel& sweep = {});

  /// The pose of `scan` in the local map, predicted by the motion so far and aligned.
  TrackedScan track(const Scan& scan) const;

  /// The same from a pose that is known roughly instead of predicted.
  TrackedScan track_from(const Scan& scan, const Pose& T_map_lidar) const;

  /// How the sensor moved during the sweep of the last scan that was committed, now that `next` has a pose: between the
  /// mean velocities before and behind it. In the lidar's frame, a second.
  Vector6d sweep_of_last(const TrackedScan& next) const;

  /// Takes the scan into the local map and the motion model.
  void commit(const TrackedScan& tracked);

  /// Forgets map and motion: the next scan starts a new segment at `T_map_lidar`.
  void restart(const Pose& T_map_lidar = Pose::Identity());

  /// The scan's points in range, deskewed to its stamp with the velocity found.
  PointCloud deskewed_cloud(const Scan& scan, const Vector6d& velocity) const;

  /// All that the next scan depends on, as bytes for the same program with the same options. set_state throws
  /// InputError on bytes that are damaged.
  std::string state() const;
  void set_state(const std::string& bytes);

  bool deskews() const;
  Compensation compensation() const { return compensation_; }
  const std::optional<surfels::LocalMap>& map() const { return map_; }

 private:
  struct Start;

  TrackedScan prepare(const Scan& scan) const;
  std::vector<Start> starts(double stamp_s) const;
  std::vector<Start> wide_starts(double stamp_s) const;
  TrackedScan best_of(const TrackedScan& prepared, const std::vector<Start>& starts, double threshold_m) const;
  TrackedScan best_of_wide(const TrackedScan& prepared, const TrackedScan& near) const;
  std::vector<Start> shortlist(const TrackedScan& prepared, const std::vector<Start>& starts) const;
  Keypoints keypoints(const TrackedScan& tracked, double cell_m) const;
  void align_from(TrackedScan& tracked, const Start& start, double threshold_m) const;
  void align_to(const surfels::LocalMap& map, TrackedScan& tracked, const Start& start, double threshold_m) const;
  void align_to_deskewed_first(TrackedScan& answer) const;
  std::vector<float> times(const PointCloud& cloud) const;
  std::vector<Eigen::Vector3f> deskewed_sample(const TrackedScan& tracked) const;
  std::vector<Eigen::Vector3d> in_map(const TrackedScan& tracked) const;
  double gap_to(double stamp_s) const;
  Vector6d during_sweep(const TrackedScan& tracked) const;
  double threshold(double gap_s) const;
  bool initialising(double stamp_s) const;
  std::vector<Start> straight_starts(const TrackedScan& prepared) const;
  void judge(TrackedScan& tracked) const;
  void begin_map(const TrackedScan& first);
  void learn_motion(const TrackedScan& tracked);
  void grow(const TrackedScan& tracked);
  void rebuild_first_scan();

  OdometryOptions options_;
  Compensation compensation_;
  cloud::SweepModel sweep_;
  std::optional<surfels::LocalMap> map_;
  std::optional<surfels::LocalMap> coarse_;  ///< the same in larger voxels, to search further
  Pose origin_ = Pose::Identity();
  std::optional<TrackedScan> last_;
  double last_gap_s_ = 0.1;  ///< between the last two scans
  std::size_t committed_ = 0;
  std::deque<double> deviations_;                       ///< metres by which the motion model missed, latest last
  Eigen::Vector3d swept_at_ = Eigen::Vector3d::Zero();  ///< where the map was last pruned
};

/// Voxel of the local map that suits a scene, metres: from how far away its surfaces are.
double voxel_for_scene(const std::vector<Eigen::Vector3f>& points);

}  // namespace loopmark::odometry

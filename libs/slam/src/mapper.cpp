// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/mapper.hpp"

#include <utility>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/slam/loop_closer.hpp"
#include "mapper_placed.hpp"

namespace loopmark {

Mapper::Mapper(const RunFolder& folder, const MapperOptions& options, std::shared_ptr<const Registrar> registrar,
               Compensation compensation, const SweepModel& sweep)
    : folder_(folder),
      options_(options),
      registrar_(std::move(registrar)),
      odometry_(options.odometry, compensation, sweep) {
  check(options_.slam);
  loop_file_ = std::make_unique<RecordWriter>(folder_.loop_records());  // refused while another process is at it,
  load();                                                               // before this one cuts anything back
  scan_file_ = std::make_unique<RecordWriter>(folder_.scan_records());
}

Mapper::~Mapper() = default;

const ScanRecord& Mapper::add(const Scan& scan) {
  Placed placed = place(scan);
  if (held_ && placed.state == ScanState::kTracked) {
    settle(odometry_.sweep_of_last(placed.tracked));
  }
  settle();
  odometry_.commit(placed.tracked);
  ScanRecord record;
  record.scan = scan.index;
  record.stamp_s = scan.stamp_s;
  record.state = placed.state;
  record.piece = piece_;
  record.T_piece_lidar = placed.tracked.T_map_lidar;
  record.velocity = placed.tracked.sweep_velocity;
  record.inlier_share = placed.tracked.health.inlier_share;
  record.residual_m = placed.tracked.health.residual_m;
  record.degenerate = placed.tracked.health.degenerate_directions.size();
  record.tracking = placed.tracked.health.tracking;
  record.covariance = placed.tracked.health.covariance;
  record.problem = placed.problem;
  if (deserves_keyframe(placed.tracked, placed.state)) {
    record.keyframe = keyframes_.size();
    if (odometry_.deskews()) {
      held_ = scan;
    } else {
      write_keyframe(scan, record);
    }
  }
  keep(std::move(record));
  return scans_.back();
}

bool Mapper::deserves_keyframe(const TrackedScan& tracked, ScanState state) const {
  constexpr double kNovelAfterM = 0.5;
  if (state != ScanState::kTracked || keyframes_.empty()) {
    return true;
  }
  const PoseError moved = pose_error(tracked.T_map_lidar, keyframes_.back().T_piece_lidar);
  const bool novel = tracked.health.unmapped_share > options_.slam.novelty && moved.translation_m > kNovelAfterM;
  return novel || moved.translation_m > options_.slam.keyframe_m || moved.rotation_deg > options_.slam.keyframe_deg;
}

void Mapper::write_keyframe(const Scan& scan, const ScanRecord& record) const {
  const PointCloud cloud = odometry_.deskewed_cloud(scan, record.velocity);
  const PointCloud thin = voxel_downsampled(cloud, options_.slam.keyframe_voxel_m);
  write_keyframe_cloud(folder_, *record.keyframe, thin);
  write_keyframe_place(folder_, *record.keyframe, thin);
  if (registrar_) {
    write_file_atomically(folder_.keyframe(*record.keyframe, "prepared"), registrar_->prepare(cloud));
  }
}

/// Writes the keyframe that was held back, with what is known of its motion.
void Mapper::settle() {
  if (held_) {
    settle(scans_.back().velocity);
  }
}

/// How the sensor moved while it took a keyframe is known best once the next scan has its pose.
void Mapper::settle(const Vector6d& velocity) {
  ScanRecord& record = scans_.back();
  record.velocity = velocity;
  write_keyframe(*held_, record);
  scan_file_->append(to_line(record));
  held_.reset();
}

void Mapper::keep(ScanRecord record) {
  if (!held_) {
    scan_file_->append(to_line(record));
  }
  scans_.push_back(std::move(record));
  path_.add(scans_.back(), keyframes_);
}

void Mapper::add_damaged(std::size_t scan, double stamp_s, const std::string& problem) {
  settle();
  ScanRecord record;
  record.scan = scan;
  record.stamp_s = stamp_s;
  record.state = ScanState::kDamaged;
  record.piece = piece_;
  record.tracking = Tracking::kLost;
  record.problem = problem;
  keep(std::move(record));
  if (++bad_scans_ > options_.slam.max_bad_scans) {
    throw InputError(std::to_string(bad_scans_) +
                     " damaged scans, more than max_bad_scans allows; the last: " + problem);
  }
}

void Mapper::close_loops(const std::function<void(std::size_t, std::size_t)>& progress) {
  end_log();
  if (!registrar_ || !options_.slam.close_loops) {
    return;
  }
  const LoopCloser closer(folder_, options_.slam, options_.pose_graph, *registrar_);
  closer.close(
      scans_, loops_, 0, [&](const LoopRecord& loop) { loop_file_->append(to_line(loop)); }, progress);
}

SolvedMap Mapper::solve() const { return solve_map(scans_, loops_, options_.slam, options_.pose_graph); }

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/mapper.hpp"

#include <algorithm>
#include <utility>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/mapping/loop_closer.hpp"
#include "loopmark/storage/files.hpp"
#include "mapper_placed.hpp"

namespace loopmark::mapping {
namespace {

/// What odometry that slides is off by, when registration cannot tell: xi in T * exp(xi).
Matrix6d unconfirmed_covariance() {
  constexpr double kMetres = 0.5;
  constexpr double kRadians = 0.05;
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(kMetres * kMetres), Eigen::Vector3d::Constant(kRadians * kRadians);
  return variances.asDiagonal();
}

}  // namespace

Mapper::Mapper(const map_store::RunFolder& folder, const MapperOptions& options,
               registration::PairRegistrationPtr registrar, odometry::Compensation compensation,
               const cloud::SweepModel& sweep)
    : folder_(folder),
      options_(options),
      registrar_(std::move(registrar)),
      odometry_(options.odometry, compensation, sweep) {
  check(options_.slam);
  loop_file_ =
      std::make_unique<storage::RecordWriter>(folder_.loop_records());  // refused while another process is at it,
  load();                                                               // before this one cuts anything back
  scan_file_ = std::make_unique<storage::RecordWriter>(folder_.scan_records());
}

Mapper::~Mapper() = default;

const map_store::ScanRecord& Mapper::add(const Scan& scan) {
  Placed placed = place(scan);
  if (pending_ && placed.state == map_store::ScanState::kTracked) {
    flush_pending(odometry_.sweep_of_last(placed.tracked));
  }
  flush_pending();
  odometry_.commit(placed.tracked);
  map_store::ScanRecord record;
  record.scan = scan.index;
  record.stamp_s = scan.stamp_s;
  record.state = placed.state;
  record.segment = segment_;
  record.T_segment_lidar = placed.tracked.T_map_lidar;
  record.velocity = placed.tracked.sweep_velocity;
  record.inlier_share = placed.tracked.tracking_status.inlier_share;
  record.residual_m = placed.tracked.tracking_status.residual_m;
  record.degenerate = placed.tracked.tracking_status.degenerate_directions.size();
  record.tracking = placed.tracked.tracking_status.tracking;
  record.covariance = placed.tracked.tracking_status.covariance;
  record.problem = placed.problem;
  if (!placed.doubt.empty()) {
    record.problem = placed.doubt;
    record.covariance += unconfirmed_covariance();
  }
  if (deserves_keyframe(placed.tracked, placed.state)) {
    record.keyframe = keyframes_.size();
    if (odometry_.deskews()) {
      pending_ = scan;
    } else {
      write_keyframe(scan, record);
    }
  }
  keep(std::move(record));
  return scans_.back();
}

bool Mapper::deserves_keyframe(const odometry::TrackedScan& tracked, map_store::ScanState state) const {
  constexpr double kNovelAfterM = 0.5;
  if (state != map_store::ScanState::kTracked || keyframes_.empty()) {
    return true;
  }
  const PoseError moved = pose_error(tracked.T_map_lidar, keyframes_.back().T_segment_lidar);
  const bool novel =
      tracked.tracking_status.unmapped_share > options_.slam.novelty && moved.translation_m > kNovelAfterM;
  return novel || moved.translation_m > options_.slam.keyframe_m || moved.rotation_deg > options_.slam.keyframe_deg;
}

void Mapper::write_keyframe(const Scan& scan, const map_store::ScanRecord& record) const {
  const PointCloud cloud = odometry_.deskewed_cloud(scan, record.velocity);
  const PointCloud thin = cloud::voxel_downsampled(cloud, options_.slam.keyframe_voxel_m);
  map_store::write_keyframe_cloud(folder_, *record.keyframe, thin);
  map_store::write_keyframe_place(folder_, *record.keyframe, thin);
  if (registrar_) {
    storage::write_file_atomically(folder_.keyframe(*record.keyframe, "prepared"),
                                   registrar_->prepare(cloud)->to_bytes());
  }
}

/// Writes the keyframe that was held back, with what is known of its motion.
void Mapper::flush_pending() {
  if (pending_) {
    flush_pending(scans_.back().velocity);
  }
}

/// How the sensor moved while it took a keyframe is known best once the next scan has its pose.
void Mapper::flush_pending(const Vector6d& velocity) {
  map_store::ScanRecord& record = scans_.back();
  record.velocity = velocity;
  write_keyframe(*pending_, record);
  append(record);
  pending_.reset();
}

void Mapper::append(const map_store::ScanRecord& record) {
  const std::string line = to_line(record);
  scan_file_->append(line);
  count_record(line);
}

void Mapper::keep(map_store::ScanRecord record) {
  if (!pending_) {
    append(record);
  }
  scans_.push_back(std::move(record));
  path_.add(scans_.back(), keyframes_);
}

void Mapper::add_copy(std::size_t scan, double stamp_s) {
  flush_pending();
  const auto original = std::find_if(scans_.rbegin(), scans_.rend(), [](const map_store::ScanRecord& s) {
    return s.state != map_store::ScanState::kDamaged;
  });
  if (original == scans_.rend()) {
    add_damaged(scan, stamp_s, "a copy of a scan that could not be used");
    return;
  }
  map_store::ScanRecord record = *original;
  record.scan = scan;
  record.stamp_s = stamp_s;
  record.state = map_store::ScanState::kCopy;
  record.keyframe.reset();
  record.problem.clear();
  keep(std::move(record));
}

void Mapper::add_damaged(std::size_t scan, double stamp_s, const std::string& problem) {
  flush_pending();
  map_store::ScanRecord record;
  record.scan = scan;
  record.stamp_s = stamp_s;
  record.state = map_store::ScanState::kDamaged;
  record.segment = segment_;
  record.tracking = odometry::Tracking::kLost;
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
      scans_, loops_, 0, [&](const map_store::LoopRecord& loop) { loop_file_->append(to_line(loop)); }, progress);
}

SolvedMap Mapper::solve() const { return solve_map(scans_, loops_, options_.slam, options_.pose_graph); }

}  // namespace loopmark::mapping

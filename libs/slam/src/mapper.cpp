// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/mapper.hpp"

#include <algorithm>
#include <utility>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/slam/loop_closer.hpp"
#include "mapper_placed.hpp"

namespace loopmark {
namespace {

std::filesystem::path state_file(const RunFolder& folder) { return folder / "records/odometry.state"; }

template <class Record>
std::vector<Record> read_all(const std::filesystem::path& path, Record (*parse)(const std::string&)) {
  std::vector<Record> records;
  for (const std::string& line : read_records(path).lines) {
    records.push_back(parse(line));
  }
  return records;
}

}  // namespace

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

void Mapper::load() {
  scans_ = read_all(folder_.scan_records(), scan_from_line);
  std::size_t known = 0;
  if (std::filesystem::exists(state_file(folder_))) {
    const std::string bytes = read_file(state_file(folder_));
    const std::size_t line_end = bytes.find('\n');
    known = std::stoul(bytes.substr(0, line_end));
    odometry_.set_state(bytes.substr(line_end + 1));
  }
  // Records behind the saved state are made again: the same bytes, as the odometry is the same.
  scans_.resize(std::min(scans_.size(), known));
  keep_records(folder_.scan_records(), scans_.size());
  for (const ScanRecord& scan : scans_) {
    piece_ = std::max(piece_, scan.piece);
    bad_scans_ += scan.state == ScanState::kDamaged ? 1 : 0;
  }
  for (const ScanRecord& scan : scans_) {
    path_.add(scan, keyframes_);
  }
  loops_ = read_all(folder_.loop_records(), loop_from_line);
}

void Mapper::checkpoint() const {
  const std::string state = odometry_.state();
  write_file_atomically(state_file(folder_), std::to_string(scans_.size()) + "\n" + state);
}

const ScanRecord& Mapper::add(const Scan& scan) {
  Placed placed = place(scan);
  odometry_.commit(placed.tracked);
  ScanRecord record;
  record.scan = scan.index;
  record.stamp_s = scan.stamp_s;
  record.state = placed.state;
  record.piece = piece_;
  record.T_piece_lidar = placed.tracked.T_map_lidar;
  record.velocity = placed.tracked.velocity;
  record.inlier_share = placed.tracked.health.inlier_share;
  record.residual_m = placed.tracked.health.residual_m;
  record.degenerate = placed.tracked.health.degenerate_directions.size();
  record.tracking = placed.tracked.health.tracking;
  record.covariance = placed.tracked.health.covariance;
  record.problem = placed.problem;
  if (deserves_keyframe(placed.tracked, placed.state)) {
    keep_keyframe(scan, record);
  }
  return keep(std::move(record));
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

void Mapper::keep_keyframe(const Scan& scan, ScanRecord& record) {
  record.keyframe = keyframes_.size();
  const PointCloud cloud = odometry_.deskewed_cloud(scan, record.velocity);
  const PointCloud thin = voxel_downsampled(cloud, options_.slam.keyframe_voxel_m);
  write_keyframe_cloud(folder_, *record.keyframe, thin);
  write_keyframe_place(folder_, *record.keyframe, thin);
  if (registrar_) {
    write_file_atomically(folder_.keyframe(*record.keyframe, "prepared"), registrar_->prepare(cloud));
  }
}

const ScanRecord& Mapper::keep(ScanRecord record) {
  scan_file_->append(to_line(record));
  scans_.push_back(std::move(record));
  path_.add(scans_.back(), keyframes_);
  return scans_.back();
}

void Mapper::add_damaged(std::size_t scan, double stamp_s, const std::string& problem) {
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
  if (!registrar_ || !options_.slam.close_loops) {
    return;
  }
  const LoopCloser closer(folder_, options_.slam, options_.pose_graph, *registrar_);
  closer.close(
      scans_, loops_, 0, [&](const LoopRecord& loop) { loop_file_->append(to_line(loop)); }, progress);
}

SolvedMap Mapper::solve() const { return solve_map(scans_, loops_, options_.slam, options_.pose_graph); }

}  // namespace loopmark

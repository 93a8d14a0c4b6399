// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/slam/loop_closer.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kLeastPoints = 100;  // of a scan that can be used, after thinning
constexpr double kWorthAgreeing = 0.3;     // P(correct) of an answer that another one may confirm

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

void check(const SlamOptions& o) {
  require_option(o.keyframe_m > 0.0, "keyframe_m", "must be positive");
  require_option(o.keyframe_deg > 0.0, "keyframe_deg", "must be positive");
  require_option(o.keyframe_voxel_m > 0.0, "keyframe_voxel_m", "must be positive");
  require_option(o.cloud_voxel_m > 0.0, "cloud_voxel_m", "must be positive");
  require_option(o.min_loop_p >= 0.0 && o.min_loop_p <= 1.0, "min_loop_p", "must be 0 to 1");
  require_option(o.drift_m_per_m >= 0.0 && o.drift_deg_per_m >= 0.0, "drift_m_per_m", "must not be negative");
  require_option(o.floor_m > 0.0 && o.floor_deg > 0.0, "floor_m", "must be positive");
  require_option(o.max_gap_s > 0.0, "max_gap_s", "must be positive");
  require_option(o.submap_keyframes >= 1, "submap_keyframes", "must be at least 1");
}

namespace {

bool same_place(const Pose& a, const Pose& b) {
  const PoseError error = pose_error(a, b);
  return error.translation_m < 1.0 && error.rotation_deg < 5.0;
}

/// Registers a prepared scan to the latest keyframes of the last piece, until `enough` says so of an answer.
bool registers(const Registrar& registrar, const RunFolder& folder, const std::vector<Keyframe>& keyframes,
               const SlamOptions& options, const std::string& source,
               const std::function<bool(const Pose& T_piece_lidar, double p_correct)>& enough) {
  for (std::size_t back = 0; back < options.recovery_keyframes && back < keyframes.size(); ++back) {
    const Keyframe& keyframe = keyframes[keyframes.size() - 1 - back];
    if (keyframe.piece != keyframes.back().piece) {
      break;
    }
    const RegistrationResult result = registrar.align(source, read_file(folder.keyframe(keyframe.number, "prepared")));
    const bool worth = result.answered || result.p_correct >= kWorthAgreeing;
    if (worth && enough(keyframe.T_piece_lidar * result.T_target_source, result.p_correct)) {
      return true;
    }
  }
  return false;
}

}  // namespace

/// A scan on its way into the map.
struct Mapper::Placed {
  TrackedScan tracked;
  ScanState state = ScanState::kTracked;
  std::string problem;
};

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

/// Tracks the scan; a lost one is registered to the latest keyframes; one that fits nowhere starts a new piece, and so
/// does one behind a long gap, which no motion model reaches across, unless registration confirms it.
Mapper::Placed Mapper::place(const Scan& scan) {
  Placed placed{odometry_.track(scan), ScanState::kTracked, ""};
  if (placed.tracked.sample.size() < kLeastPoints) {
    throw DamagedScan("scan " + std::to_string(scan.index) + ": only " + std::to_string(placed.tracked.sample.size()) +
                      " usable points");
  }
  if (keyframes_.empty()) {
    placed.state = ScanState::kNewPiece;
  } else if (after_gap(scan.stamp_s)) {
    // The sensor may have stood still: odometry is believed where registration, which does not know of it, agrees.
    const bool confirmed =
        registrar_ && placed.tracked.health.tracking != Tracking::kLost &&
        registers(*registrar_, folder_, keyframes_, options_.slam,
                  registrar_->prepare(odometry_.deskewed_cloud(scan, placed.tracked.velocity)),
                  [&](const Pose& pose, double) { return same_place(pose, placed.tracked.T_map_lidar); });
    if (!confirmed) {
      start_piece(scan, "a gap between the scans", placed);
    }
  } else if (placed.tracked.health.tracking == Tracking::kLost) {
    placed.problem = placed.tracked.health.reason;
    if (recover(scan, placed)) {
      placed.state = ScanState::kRecovered;
    } else {
      start_piece(scan, placed.problem, placed);
    }
  }
  return placed;
}

/// Whether the gap to the last good scan is long, both in seconds and against those before. Stamps that jump back are a
/// gap, too.
bool Mapper::after_gap(double stamp_s) const {
  constexpr std::size_t kRemembered = 20;
  constexpr std::size_t kLeastKnown = 5;
  constexpr double kTimesUsual = 10.0;
  std::vector<double> stamps;
  for (auto scan = scans_.rbegin(); scan != scans_.rend() && stamps.size() <= kRemembered; ++scan) {
    if (scan->state != ScanState::kDamaged) {
      stamps.push_back(scan->stamp_s);
    }
  }
  std::vector<double> gaps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    gaps.push_back(std::abs(stamps[i - 1] - stamps[i]));
  }
  if (gaps.size() < kLeastKnown) {
    return false;
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return std::abs(stamp_s - stamps.front()) > std::max(options_.slam.max_gap_s, kTimesUsual * *middle);
}

/// The new piece starts where the motion so far would have led: a guess that nothing else rests on.
void Mapper::start_piece(const Scan& scan, const std::string& problem, Placed& placed) {
  const auto last =
      std::find_if(scans_.rbegin(), scans_.rend(), [](const ScanRecord& s) { return s.state != ScanState::kDamaged; });
  const double ahead_s = std::clamp(scan.stamp_s - last->stamp_s, 0.0, options_.slam.max_gap_s);
  odometry_.restart(last->T_piece_lidar * exp_se3(ahead_s * last->velocity));
  placed.tracked = odometry_.track(scan);
  placed.state = ScanState::kNewPiece;
  placed.problem = problem;
  ++piece_;
}

/// Global registration to the latest keyframes of the piece: two answers that agree, even if neither is sure by itself
/// (what deceives a registration moves along with the sensor, and so says different places for different keyframes), or
/// a sure one where the piece has no second keyframe.
bool Mapper::recover(const Scan& scan, Placed& placed) const {
  if (!registrar_) {
    return false;
  }
  const bool only_one = keyframes_.size() < 2 || keyframes_[keyframes_.size() - 2].piece != piece_ ||
                        options_.slam.recovery_keyframes < 2;
  std::vector<Pose> answers;
  const std::string source = registrar_->prepare(odometry_.deskewed_cloud(scan, placed.tracked.velocity));
  return registers(*registrar_, folder_, keyframes_, options_.slam, source, [&](const Pose& pose, double p_correct) {
    const bool agrees =
        std::any_of(answers.begin(), answers.end(), [&](const Pose& other) { return same_place(pose, other); });
    if (agrees || (only_one && p_correct >= options_.slam.min_loop_p)) {
      placed.tracked = odometry_.track_from(scan, pose);
      if (!same_place(placed.tracked.T_map_lidar, pose)) {
        placed.tracked.T_map_lidar = pose;  // the local map draws it elsewhere: believe the registration
      }
      return true;
    }
    answers.push_back(pose);
    return false;
  });
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

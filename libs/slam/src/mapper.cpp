// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/mapper.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/places/place_index.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kLeastPoints = 100;    // of a scan that can be used, after thinning
constexpr double kWorthAgreeing = 0.3;       // P(correct) of an answer that another one may confirm
constexpr std::size_t kPieceNeighbours = 3;  // keyframes before a new piece that its first keyframes are tried with

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
}

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
  load();
  scan_file_ = std::make_unique<RecordWriter>(folder_.scan_records());
  loop_file_ = std::make_unique<RecordWriter>(folder_.loop_records());
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

/// Tracks the scan; a lost one is registered to the latest keyframes; one that fits nowhere starts a new piece.
Mapper::Placed Mapper::place(const Scan& scan) {
  Placed placed{odometry_.track(scan), ScanState::kTracked, ""};
  if (placed.tracked.sample.size() < kLeastPoints) {
    throw DamagedScan("scan " + std::to_string(scan.index) + ": only " + std::to_string(placed.tracked.sample.size()) +
                      " usable points");
  }
  if (keyframes_.empty()) {
    placed.state = ScanState::kNewPiece;
  } else if (placed.tracked.health.tracking == Tracking::kLost) {
    placed.problem = placed.tracked.health.reason;
    if (recover(scan, placed)) {
      placed.state = ScanState::kRecovered;
    } else {
      // Where the motion so far would have led: a guess that only the start of the new piece rests on.
      const ScanRecord& last = scans_.back();
      odometry_.restart(last.T_piece_lidar * exp_se3((scan.stamp_s - last.stamp_s) * last.velocity));
      placed.tracked = odometry_.track(scan);
      placed.state = ScanState::kNewPiece;
      ++piece_;
    }
  }
  return placed;
}

/// Global registration to the latest keyframes of the piece: one sure answer, or two that agree. Two that are not sure
/// each by itself count too: what deceives a registration moves along with the sensor, and so says different places
/// when the keyframes are at different places.
bool Mapper::recover(const Scan& scan, Placed& placed) const {
  if (!registrar_) {
    return false;
  }
  const std::string source = registrar_->prepare(odometry_.deskewed_cloud(scan, placed.tracked.velocity));
  std::vector<Pose> answers;
  for (std::size_t back = 0; back < options_.slam.recovery_keyframes && back < keyframes_.size(); ++back) {
    const Keyframe& keyframe = keyframes_[keyframes_.size() - 1 - back];
    if (keyframe.piece != piece_) {
      break;
    }
    const RegistrationResult result =
        registrar_->align(source, read_file(folder_.keyframe(keyframe.number, "prepared")));
    if (!result.answered && result.p_correct < kWorthAgreeing) {
      continue;
    }
    const Pose pose = keyframe.T_piece_lidar * result.T_target_source;
    const bool agrees = std::any_of(answers.begin(), answers.end(), [&](const Pose& other) {
      const PoseError error = pose_error(pose, other);
      return error.translation_m < 1.0 && error.rotation_deg < 5.0;
    });
    if (agrees || result.p_correct >= options_.slam.min_loop_p) {
      placed.tracked = odometry_.track_from(scan, pose);
      const PoseError moved = pose_error(placed.tracked.T_map_lidar, pose);
      if (moved.translation_m > 1.0 || moved.rotation_deg > 5.0) {
        placed.tracked.T_map_lidar = pose;  // the local map draws it elsewhere: believe the registration
      }
      return true;
    }
    answers.push_back(pose);
  }
  return false;
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

/// Places that look alike, and for the first keyframes of a piece the last ones of the pieces before.
std::vector<std::vector<LoopRecord>> Mapper::candidates() const {
  std::vector<std::vector<LoopRecord>> result(keyframes_.size());
  PlaceIndex index;
  double looked_up_m = -options_.slam.loop_every_m;
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    std::set<std::size_t> tried;
    const auto add = [&](std::size_t target, const char* origin) {
      if (tried.insert(target).second) {
        LoopRecord candidate;
        candidate.source = k;
        candidate.target = target;
        candidate.origin = origin;
        result[k].push_back(candidate);
      }
    };
    for (std::size_t back = 1; back <= kPieceNeighbours && back <= k; ++back) {
      if (keyframes_[k - back].piece != keyframes_[k].piece) {
        add(k - back, "neighbour");
      }
    }
    const PlaceSignature signature = read_keyframe_place(folder_, k);
    const auto apart = [&](std::size_t earlier) {
      return keyframes_[earlier].piece != keyframes_[k].piece ||
             comes_back(keyframes_[earlier], keyframes_[k], options_.slam.loop_gap_m);
    };
    const bool due = keyframes_[k].path_m - looked_up_m >= options_.slam.loop_every_m;
    looked_up_m = due ? keyframes_[k].path_m : looked_up_m;
    for (const PlaceMatch& match : index.query(signature, due ? options_.slam.loop_candidates : 0, apart)) {
      add(match.id, "place");
    }
    index.add(k, signature);
  }
  return result;
}

void Mapper::close_loops(const std::function<void(std::size_t, std::size_t)>& progress) {
  if (!registrar_ || !options_.slam.close_loops) {
    return;
  }
  constexpr std::size_t kBatch = 8;  // between two looks at the interrupt flag
  std::vector<LoopRecord> todo;
  for (const std::vector<LoopRecord>& of_keyframe : candidates()) {
    todo.insert(todo.end(), of_keyframe.begin(), of_keyframe.end());
  }
  // Candidates follow from the keyframes alone, so those on record are the first ones.
  for (std::size_t done = loops_.size(); done < todo.size();) {
    check_interrupt();
    const std::size_t batch = std::min(kBatch, todo.size() - done);
    parallel_for(batch, [&](std::size_t i) { todo[done + i] = registered(todo[done + i]); });
    for (std::size_t i = 0; i < batch; ++i, ++done) {
      loop_file_->append(to_line(todo[done]));
      loops_.push_back(todo[done]);
    }
    if (progress) {
      progress(done, todo.size());
    }
  }
}

LoopRecord Mapper::registered(LoopRecord candidate) const {
  const RegistrationResult result = registrar_->align(read_file(folder_.keyframe(candidate.source, "prepared")),
                                                      read_file(folder_.keyframe(candidate.target, "prepared")));
  candidate.answered = result.answered;
  candidate.reason = result.reason;
  candidate.p_correct = result.p_correct;
  candidate.T_target_source = result.T_target_source;
  candidate.covariance = result.covariance;
  if (!result.modes.empty()) {
    candidate.evidence = result.modes.front().evidence;
  }
  return candidate;
}

SolvedMap Mapper::solve() const { return solve_map(scans_, loops_, options_.slam, options_.pose_graph); }

}  // namespace loopmark

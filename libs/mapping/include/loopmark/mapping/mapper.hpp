// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/map_store/records.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/odometry/odometry.hpp"
#include "loopmark/registration/pair_registration.hpp"
#include "loopmark/storage/record_file.hpp"
#include "loopmark/storage/sha256.hpp"

namespace loopmark::mapping {

struct MapperOptions {
  odometry::OdometryOptions odometry;
  SlamOptions slam;
  pose_graph::PoseGraphOptions pose_graph;
};

/// Turns scans into a map, fed one by one. All it learns is written into the run folder at once: memory holds the local
/// map and a few numbers a scan. A mapper made on a folder that holds records goes on behind them.
class Mapper {
 public:
  /// `registrar` may be null: then lost scans start new segments and no loop is closed.
  Mapper(const map_store::RunFolder& folder, const MapperOptions& options, registration::PairRegistrationPtr registrar,
         odometry::Compensation compensation, const cloud::SweepModel& sweep);
  ~Mapper();

  /// The next scan of the log. The scan becomes part of the odometry, and a keyframe where it shows something new.
  /// Throws DamagedScan when it holds too few points to be used.
  const map_store::ScanRecord& add(const Scan& scan);

  /// The log is over: the last keyframe does not wait for another scan.
  void end_log() { flush_pending(); }

  /// A scan with the very points of the one before it (a recorder that heard a topic twice): no motion, and nothing
  /// new.
  void add_copy(std::size_t scan, double stamp_s);

  /// How the scans are deskewed.
  odometry::Compensation compensation() const { return odometry_.compensation(); }

  /// A scan that cannot be used. Throws InputError when there have been more than max_bad_scans.
  void add_damaged(std::size_t scan, double stamp_s, const std::string& problem);

  /// Tries every place that keyframes may have seen before, then every segment that nothing joins yet against all
  /// others; `progress` is called with (done, total).
  void close_loops(const std::function<void(std::size_t, std::size_t)>& progress = {});

  /// The poses as known now. At least one scan has been added.
  SolvedMap solve() const;

  /// Saves the state of the odometry, so that a mapper made on this folder goes on from here, whatever a kill or a
  /// power cut does to what comes behind.
  void checkpoint() const;

  const std::vector<map_store::ScanRecord>& scans() const { return scans_; }
  const std::vector<map_store::LoopRecord>& loops() const { return loops_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }

 private:
  struct Placed;

  void load();
  void begin_with(std::vector<map_store::ScanRecord> scans, std::size_t known, bool newest);
  void count_record(const std::string& line);
  Placed place(const Scan& scan);
  bool doubtful(const odometry::TrackedScan& tracked) const;
  void check_odometry(const Scan& scan, Placed& placed);
  void believe_registration(const Scan& scan, const Pose& T_segment_lidar, Placed& placed) const;
  bool recover(const Scan& scan, Placed& placed) const;
  bool deserves_keyframe(const odometry::TrackedScan& tracked, map_store::ScanState state) const;
  void write_keyframe(const Scan& scan, const map_store::ScanRecord& record) const;
  void flush_pending();
  void flush_pending(const Vector6d& velocity);
  void keep(map_store::ScanRecord record);
  void append(const map_store::ScanRecord& record);
  bool after_gap(double stamp_s) const;
  void start_segment(const Scan& scan, const std::string& problem, Placed& placed);

  const map_store::RunFolder& folder_;
  MapperOptions options_;
  registration::PairRegistrationPtr registrar_;
  odometry::Odometry odometry_;
  std::size_t segment_ = 0;
  std::size_t bad_scans_ = 0;
  std::vector<map_store::ScanRecord> scans_;
  std::optional<Scan> pending_;  ///< the last of scans_, a keyframe that waits for the next scan
  std::vector<Keyframe> keyframes_;
  DrivenPath path_;
  std::vector<map_store::LoopRecord> loops_;
  storage::Sha256 records_sum_;  ///< of the scan records, as written
  std::unique_ptr<storage::RecordWriter> scan_file_;
  std::unique_ptr<storage::RecordWriter> loop_file_;
};

}  // namespace loopmark::mapping

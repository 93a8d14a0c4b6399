// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/core/record_file.hpp"
#include "loopmark/odometry/odometry.hpp"
#include "loopmark/slam/records.hpp"
#include "loopmark/slam/registrar.hpp"
#include "loopmark/slam/run_folder.hpp"
#include "loopmark/slam/solved_map.hpp"

namespace loopmark {

struct MapperOptions {
  OdometryOptions odometry;
  SlamOptions slam;
  PoseGraphOptions pose_graph;
};

/// Turns scans into a map, fed one by one. All it learns is written into the run folder at once: memory holds the local
/// map and a few numbers a scan. A mapper made on a folder that holds records goes on behind them.
class Mapper {
 public:
  /// `registrar` may be null: then lost scans start new pieces and no loop is closed.
  Mapper(const RunFolder& folder, const MapperOptions& options, std::shared_ptr<const Registrar> registrar,
         Compensation compensation, const SweepModel& sweep);
  ~Mapper();

  /// The next scan of the log. The scan becomes part of the odometry, and a keyframe where it shows something new.
  /// Throws DamagedScan when it holds too few points to be used.
  const ScanRecord& add(const Scan& scan);

  /// The log is over: the last keyframe does not wait for another scan.
  void end_log() { settle(); }

  /// A scan that cannot be used. Throws InputError when there have been more than max_bad_scans.
  void add_damaged(std::size_t scan, double stamp_s, const std::string& problem);

  /// Tries every place that keyframes may have seen before, then every piece that nothing joins yet against all others;
  /// `progress` is called with (done, total).
  void close_loops(const std::function<void(std::size_t, std::size_t)>& progress = {});

  /// The poses as known now. At least one scan has been added.
  SolvedMap solve() const;

  /// Saves the state of the odometry, so that a mapper made on this folder goes on from here.
  void checkpoint() const;

  const std::vector<ScanRecord>& scans() const { return scans_; }
  const std::vector<LoopRecord>& loops() const { return loops_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }

 private:
  struct Placed;

  void load();
  Placed place(const Scan& scan);
  bool recover(const Scan& scan, Placed& placed) const;
  bool deserves_keyframe(const TrackedScan& tracked, ScanState state) const;
  void write_keyframe(const Scan& scan, const ScanRecord& record) const;
  void settle();
  void settle(const Vector6d& velocity);
  void keep(ScanRecord record);
  bool after_gap(double stamp_s) const;
  void start_piece(const Scan& scan, const std::string& problem, Placed& placed);

  const RunFolder& folder_;
  MapperOptions options_;
  std::shared_ptr<const Registrar> registrar_;
  Odometry odometry_;
  std::size_t piece_ = 0;
  std::size_t bad_scans_ = 0;
  std::vector<ScanRecord> scans_;
  std::optional<Scan> held_;  ///< the last of scans_, a keyframe that waits for the next scan
  std::vector<Keyframe> keyframes_;
  DrivenPath path_;
  std::vector<LoopRecord> loops_;
  std::unique_ptr<RecordWriter> scan_file_;
  std::unique_ptr<RecordWriter> loop_file_;
};

}  // namespace loopmark

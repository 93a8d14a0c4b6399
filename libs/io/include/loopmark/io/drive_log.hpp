// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Drive logs: the scans of one drive in order, whatever their files look like.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/core/error.hpp"
#include "loopmark/core/options.hpp"
#include "loopmark/core/point_cloud.hpp"
#include "loopmark/io/sweep.hpp"

namespace loopmark::io {

/// A scan that cannot be read or makes no sense; the run may skip and count it.
class DamagedScan : public InputError {
 public:
  using InputError::InputError;
};

/// What is known of a log before its scans are read.
struct LogInfo {
  std::string format;          ///< "kitti-odometry", "kitti-raw", "folder-pcd", "rawlog", ...
  std::filesystem::path path;  ///< the folder or file that was opened
  bool stamps_given = false;   ///< stamps come from the log; else from the stated rate
  bool truth_given = false;    ///< reference poses lie beside the scans
  std::string stamps_source;   ///< "times.txt", "file names", "rate 10 Hz", ...
  std::string truth_source;    ///< the file of the reference poses
  std::string truth_problem;   ///< why poses that lie there are not used; empty when all is well
  std::string problem;         ///< what is wrong with the log as a whole (a truncated rawlog); empty when nothing is
  std::vector<std::filesystem::path> companions;  ///< files beside the scans that were read: times, poses, calibration
  std::optional<cloud::SweepModel> sweep;         ///< how the points' times are rebuilt where the log has none
  std::optional<bool> motion_compensated;         ///< what the log itself says, not measured
};

/// Points that a reader left out, by reason.
struct DroppedPoints {
  std::size_t not_finite = 0;                              ///< NaN or infinite coordinates
  std::size_t absurd = 0;                                  ///< farther than LogOptions::max_range_m
  double nearest_absurd_m = 0.0, farthest_absurd_m = 0.0;  ///< of these
  std::size_t no_return = 0;  ///< exactly (0, 0, 0): how many drivers write a beam without echo
};

/// A scan with what reading it showed.
struct ScanReading {
  Scan scan;
  DroppedPoints dropped;
  bool times_in_file = false;  ///< per-point times came from the file
  bool times_rebuilt = false;  ///< per-point times were rebuilt from the azimuth
  bool has_viewpoint = false;  ///< the file's header moves the points (PCD: VIEWPOINT); the motion is not applied
};

/// A drive log: its scans in order. Reading is thread-safe and keeps nothing in memory.
class DriveLog {
 public:
  virtual ~DriveLog() = default;
  virtual std::size_t size() const = 0;
  virtual double stamp_s(std::size_t index) const = 0;
  /// The scan's file or place in the log, for messages.
  virtual std::string scan_name(std::size_t index) const = 0;
  /// The file that holds the scan; a rawlog holds them all. Empty where there is none.
  virtual std::filesystem::path scan_file(std::size_t /*index*/) const { return {}; }
  /// Reads scan `index`. Throws DamagedScan naming the file, the place and the problem.
  virtual Scan read(std::size_t index) const = 0;
  /// The same with what reading it showed.
  virtual ScanReading read_closely(std::size_t index) const { return {read(index), {}, false, false, false}; }
  /// The scan's own number where the log counts otherwise than from 0 without gaps (its file's name).
  virtual std::size_t frame_number(std::size_t index) const { return index; }
  virtual const LogInfo& info() const = 0;
  /// Reference poses T_world_lidar, one a scan, where info().truth_given; else empty.
  virtual std::vector<Pose> truth() const = 0;
};

/// How the times of the points are found where the files have none.
enum class RebuildTimes { kAuto, kNever, kClockwise, kCounterClockwise };

struct LogOptions {
  double rate_hz = 10.0;        ///< scans per second where the log has no times
  std::string format = "auto";  ///< forces a format
  std::string sensor_label;     ///< rawlogs: only observations with this label; empty: the first found
  std::size_t min_points = 50;  ///< a scan with fewer usable points is damaged
  double max_range_m = 1000.0;  ///< points beyond are left out as absurd
  std::size_t bin_columns = 0;  ///< float32 values a point in .bin files; 0: as they show, else 4, and 5 in .pcd.bin
  RebuildTimes rebuild_times = RebuildTimes::kAuto;  ///< auto: where the log says how its sensor sweeps
};

template <class Visitor>
void describe(Visitor& v, LogOptions& o) {
  v.field("rate_hz", o.rate_hz, "scans per second where the log has no times");
  v.field("format", o.format,
          "auto, or the format to force: kitti-odometry, kitti-raw, mulran, apollo, folder, rawlog");
  v.field("sensor_label", o.sensor_label, "rawlogs: only observations with this label; empty: the first found");
  v.field("min_points", o.min_points, "a scan with fewer usable points is damaged");
  v.field("max_range_m", o.max_range_m, "points beyond this range are left out as absurd, metres");
  v.field("bin_columns", o.bin_columns,
          "float32 values a point in .bin files; 0: as they show, else 4, and 5 in .pcd.bin");
  v.choice("rebuild_times", o.rebuild_times,
           {{"auto", RebuildTimes::kAuto},
            {"never", RebuildTimes::kNever},
            {"clockwise", RebuildTimes::kClockwise},
            {"counter_clockwise", RebuildTimes::kCounterClockwise}},
           "times of the points from their azimuth where the files have none; auto: where the log says how "
           "its sensor sweeps");
}

/// Throws InputError naming the option that makes no sense.
void check(const LogOptions& options);

/// Opens a log, guessing its format from what is there. Throws InputError when nothing readable is found.
std::unique_ptr<DriveLog> open_log(const std::filesystem::path& path, const LogOptions& options = {});

}  // namespace loopmark::io

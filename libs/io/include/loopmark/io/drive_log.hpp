// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "loopmark/core/error.hpp"
#include "loopmark/core/point_cloud.hpp"

namespace loopmark {

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
};

/// A drive log: its scans in order. Reading is thread-safe and keeps nothing in memory.
class DriveLog {
 public:
  virtual ~DriveLog() = default;
  virtual std::size_t size() const = 0;
  virtual double stamp_s(std::size_t index) const = 0;
  /// The scan's file or place in the log, for messages.
  virtual std::string scan_name(std::size_t index) const = 0;
  /// Reads scan `index`. Throws DamagedScan naming the file, the place and the problem.
  virtual Scan read(std::size_t index) const = 0;
  virtual const LogInfo& info() const = 0;
  /// Reference poses T_world_lidar, one a scan, where info().truth_given; else empty.
  virtual std::vector<Pose> truth() const = 0;
};

struct LogOptions {
  double rate_hz = 10.0;        ///< scans per second where the log has no times
  std::string format = "auto";  ///< forces a format
  std::string sensor_label;     ///< rawlogs: only observations with this label; empty: the first found
};

template <class Visitor>
void describe(Visitor& v, LogOptions& o) {
  v.field("rate_hz", o.rate_hz, "scans per second where the log has no times");
  v.field("format", o.format, "auto, or the format to force");
  v.field("sensor_label", o.sensor_label, "rawlogs: only observations with this label; empty: the first found");
}

/// Opens a log, guessing its format from what is there. Throws InputError when nothing readable is found.
std::unique_ptr<DriveLog> open_log(const std::filesystem::path& path, const LogOptions& options = {});

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A log whose scans are files of their own; what every layout on disk becomes.
#pragma once

#include <optional>
#include <vector>

#include "loopmark/io/drive_log.hpp"

namespace loopmark::io::internal {

/// All that a FileLog knows; `stamps_s` and `frame_numbers` are as long as `files`, `truth` too or empty.
struct FileLogParts {
  LogInfo info;
  std::vector<std::filesystem::path> files;
  std::vector<double> stamps_s;
  std::vector<std::size_t> frame_numbers;
  std::vector<Pose> truth;
  std::optional<Pose> T_cloud_sensor;  ///< moves the points when they are read
  LogOptions options;
};

class FileLog : public DriveLog {
 public:
  explicit FileLog(FileLogParts parts) : parts_(std::move(parts)) {}

  std::size_t size() const override { return parts_.files.size(); }
  double stamp_s(std::size_t index) const override { return parts_.stamps_s.at(index); }
  std::string scan_name(std::size_t index) const override { return parts_.files.at(index).string(); }
  std::filesystem::path scan_file(std::size_t index) const override { return parts_.files.at(index); }
  Scan read(std::size_t index) const override { return read_closely(index).scan; }
  ScanReading read_closely(std::size_t index) const override;
  std::size_t frame_number(std::size_t index) const override { return parts_.frame_numbers.at(index); }
  const LogInfo& info() const override { return parts_.info; }
  std::vector<Pose> truth() const override { return parts_.truth; }

 private:
  FileLogParts parts_;
};

/// What all logs do with a scan once its points are there: too few points are an error, points without times
/// get them where the log says how its sensor sweeps. Throws DamagedScan.
void finish_reading(ScanReading& reading, const std::string& scan_name, const LogInfo& info, const LogOptions& options);

}  // namespace loopmark::io::internal

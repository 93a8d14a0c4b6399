// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Drive logs, written in formats that other programs read.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/observations.hpp"

namespace loopmark::io {

/// Takes what a log holds in the order of time. It is there whole or not at all.
class LogWriter {
 public:
  virtual ~LogWriter() = default;
  /// `T_world_lidar`: where the scan was taken, as far as it is known; for all scans of a log or for none.
  virtual void add(const Scan& scan, const std::optional<Pose>& T_world_lidar) = 0;
  /// Formats without a place for it leave it out.
  virtual void add(const Observation& observation) = 0;
  /// Where other frames are on the LiDAR, T_lidar_frame; before the first scan.
  virtual void add_mounts(const std::map<std::string, Pose>& /*mounts*/) {}
  virtual void finish() = 0;
};

/// "kitti", "pcd", "mcap", "rosbag1", "rosbag2".
const std::vector<std::string>& log_writer_formats();

/// Throws InputError for an unknown format, and where `path` is there already.
///   kitti    folder with velodyne/%06d.bin (x y z intensity), times.txt, poses.txt
///   pcd      the same with .pcd files that have ring and time of each point
///   mcap, rosbag1, rosbag2   /points (PointCloud2 with intensity, ring, time in seconds from the stamp), the topics of
///            IMU, GNSS and odometry, /tf_static, /ground_truth (nav_msgs/Odometry) where poses are known
std::unique_ptr<LogWriter> create_log_writer(const std::string& format, const std::filesystem::path& path);

/// Which part of a log.
struct ConvertOptions {
  double from_s = 0.0;  ///< since the first scan
  double to_s = 1e12;
  std::size_t every = 1;  ///< each so-manieth scan
};

struct ConvertedLog {
  std::size_t scans = 0, damaged = 0, observations = 0;
  std::vector<std::string> problems;  ///< of the first few damaged scans
};

/// Reads all of a log and writes it.
ConvertedLog convert_log(const DriveLog& log, LogWriter& writer, const ConvertOptions& options = {});

}  // namespace loopmark::io

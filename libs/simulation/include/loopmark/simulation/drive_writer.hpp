// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "loopmark/simulation/sweep.hpp"

namespace loopmark::simulation {

enum class LogFormat { kKitti, kPcd, kRawlog };

struct WriteOptions {
  LogFormat format = LogFormat::kKitti;
  bool compensated = false;  ///< scans in the frame of their stamp; else each point at its own moment
};

template <class Visitor>
void describe(Visitor& v, WriteOptions& o) {
  v.choice("format", o.format, {{"kitti", LogFormat::kKitti}, {"pcd", LogFormat::kPcd}, {"rawlog", LogFormat::kRawlog}},
           "format of the scans");
  v.field("compensated", o.compensated, "scans in the frame of their stamp; else each point at its own moment");
}

/// What a written log holds.
struct WrittenLog {
  std::size_t scans = 0;
  std::size_t points = 0;
  double length_m = 0.0;
};

/// Renders and writes a drive to `folder`:
///   velodyne/%06d.bin   x y z intensity as float32 (KITTI), or %06d.pcd with x y z intensity ring t,
///                       or instead of the folder drive.rawlog with times, rings and the truth (MRPT)
///   times.txt           stamp of each scan, seconds
///   poses.txt           truth: T_first_scan, 3x4 row-major, of the sensor at the stamp of each scan
///   calib.txt           KITTI's file; Tr is the identity: poses are of the LiDAR itself
///   sweep.txt           how the time of a point follows from its azimuth
///   revisits.csv        the stretches that come back to earlier ones
///   town.json           how the log was made
/// The folder appears whole or not at all: it is written as FOLDER.partial and renamed. Throws InputError when it
/// exists.
WrittenLog write_drive(const World& world, const Town& town, const Drive& drive, const std::filesystem::path& folder,
                       const WriteOptions& options);

}  // namespace loopmark::simulation

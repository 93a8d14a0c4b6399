// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A drive through a synthetic street as a log on disk, with its truth.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "support/box_world.hpp"

namespace loopmark::testing_support {

/// `count` (at most 110) raw sweeps with a time for every point, 0.1 s apart at 10 m/s, `offset_m` to the left of the
/// lane. `seed`: of the street; `noise`: of the ranges. What was at `log` is removed.
inline void write_passing_log(const std::filesystem::path& log, double offset_m, std::uint64_t noise, int count = 110,
                              std::uint64_t seed = 5) {
  std::filesystem::remove_all(log);
  std::filesystem::create_directories(log);
  const BoxWorld world = street(140.0, seed);
  const Vector6d velocity = (Vector6d() << 10.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished();
  std::ofstream times(log / "times.txt");
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    times << 0.1 * i << "\n";
    poses.push_back(pose_from_yaw(0.0, {static_cast<double>(i), offset_m, 1.8}));
    char file[32];
    std::snprintf(file, sizeof file, "%06d.pcd", i);
    io::write_pcd(log / file, sweep(world, poses.back(), velocity, 0.02, noise + static_cast<std::uint64_t>(i)));
  }
  io::write_kitti(log / "poses.txt", poses);
}

/// The setting that such a log is mapped, drilled and relocalized with.
inline const char* const kPassingLogSetting = "slam.compensation=raw_given_times";

}  // namespace loopmark::testing_support

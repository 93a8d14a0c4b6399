// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Logs of drives along a synthetic street, there and back, with gaps and jumps where a test wants them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "support/box_world.hpp"

namespace loopmark::testing_support {

struct StreetScan {
  double stamp_s = 0.0;
  Pose T_street_lidar = Pose::Identity();
  const BoxWorld* world = nullptr;
};

/// One scan a metre at 10 m/s from `begin_m` to `end_m` along the street: there on its right, back on the other side.
inline std::vector<StreetScan> driven(const BoxWorld& world, int begin_m, int end_m, double start_s) {
  std::vector<StreetScan> scans;
  const int step = begin_m < end_m ? 1 : -1;
  for (int x = begin_m; x != end_m; x += step) {
    scans.push_back({start_s + 0.1 * static_cast<double>(scans.size()),
                     pose_from_yaw(step > 0 ? 0.0 : M_PI, {static_cast<double>(x), -1.5 * step, 1.8}), &world});
  }
  return scans;
}

/// Scans as if taken at one instant, with `beams` beams; the truth in the street's frame lies beside them.
inline void write_street_log(const std::filesystem::path& log, const std::vector<StreetScan>& scans, int beams = 24,
                             std::uint64_t seed = 0) {
  std::filesystem::create_directories(log);
  std::ofstream times(log / "times.txt");
  times.precision(12);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    PointCloud cloud = sweep(*scans[i].world, scans[i].T_street_lidar, Vector6d::Zero(), 0.02, seed + i, beams);
    cloud.time_offset_s.clear();
    std::string number = std::to_string(i);
    number.insert(0, 6 - number.size(), '0');
    io::write_pcd(log / (number + ".pcd"), cloud);
    times << scans[i].stamp_s << "\n";
    poses.push_back(scans[i].T_street_lidar);
  }
  io::write_kitti(log / "poses.txt", poses);
}

/// What loopmark map has to be told of such a log.
inline const std::vector<std::string> kStreetOptions = {"-q", "--set", "slam.compensation=compensated"};

}  // namespace loopmark::testing_support

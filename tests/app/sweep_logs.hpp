// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A short drive through a synthetic street, written as a log, and `loopmark map` run on it as a user does.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/storage/files.hpp"
#include "support/box_world.hpp"
#include "support/run_program.hpp"

namespace loopmark::testing_support {

/// Logs and runs of one process of a test program, below a folder of its own, which goes with it.
class StreetLogs {
 public:
  static constexpr int kScans = 24;

  explicit StreetLogs(const std::string& name)
      : folder_(std::filesystem::path(testing::TempDir()) / ("loopmark_" + name + "_" + std::to_string(::getpid()))) {}
  ~StreetLogs() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  StreetLogs(const StreetLogs&) = delete;
  StreetLogs& operator=(const StreetLogs&) = delete;

  std::filesystem::path scratch(const std::string& what) const {
    std::filesystem::create_directories(folder_);
    return folder_ / what;
  }

  /// A log of sweeps with a time for every point, driven at 10 m/s through a gentle curve from the first scan on.
  std::filesystem::path make_log(const std::string& what) const {
    const std::filesystem::path log = scratch(what);
    std::filesystem::remove_all(log);
    std::filesystem::create_directories(log);
    const BoxWorld world = street(120.0, 5);
    const Vector6d velocity = (Vector6d() << 10.0, 0.0, 0.0, 0.0, 0.0, 0.05).finished();
    std::vector<double> stamps;
    std::vector<Pose> poses;
    for (int i = 0; i < kScans; ++i) {
      stamps.push_back(0.1 * i);
      poses.push_back(pose_from_yaw(-0.05, {0.0, 0.0, 1.8}) * exp_se3(0.1 * i * velocity));
      io::write_pcd(log / scan_name(i), sweep(world, poses.back(), velocity, 0.02, static_cast<std::uint64_t>(i)));
    }
    write_times(log, stamps);
    io::write_kitti(log / "poses.txt", poses);
    return log;
  }

  static std::string scan_name(int i) {
    char file[32];
    std::snprintf(file, sizeof file, "%06d.pcd", i);
    return file;
  }

  static void write_times(const std::filesystem::path& log, const std::vector<double>& stamps) {
    std::ofstream times(log / "times.txt");
    for (const double stamp : stamps) {
      times << stamp << "\n";
    }
  }

  /// The name of a run that is not there.
  std::filesystem::path new_run(const std::string& what) const {
    const std::filesystem::path run = scratch(what);
    std::filesystem::remove_all(run);
    std::filesystem::remove_all(run.string() + ".partial");
    return run;
  }

 private:
  std::filesystem::path folder_;
};

/// The words of `loopmark map LOG -o RUN MORE...` for such a log.
inline std::vector<std::string> map_words(const std::filesystem::path& log, const std::filesystem::path& run,
                                          const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"map", log, "-o", run, "-q", "--set", "slam.compensation=raw_given_times"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline const char* const kMapProducts[] = {"trajectory.tum", "trajectory.kitti", "covariances.csv", "pose_graph.g2o",
                                           "loops.csv",      "map.bt",           "map.ot",          "cloud.ply",
                                           "map.simplemap",  "map.3Dscene",      "config.yaml",     "summary.json"};

inline void expect_same_products(const std::filesystem::path& a, const std::filesystem::path& b) {
  for (const char* const product : kMapProducts) {
    EXPECT_EQ(storage::sha256_of_file(a / product), storage::sha256_of_file(b / product)) << product;
  }
}

}  // namespace loopmark::testing_support

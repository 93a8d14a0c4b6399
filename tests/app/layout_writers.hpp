// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Small drives written in the layouts of the data sets that balanced sets were published for.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "pair_sets/small_drives.hpp"

namespace loopmark::test {

namespace fs = std::filesystem;

inline void write_text(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string quaternion_text(const Pose& pose, bool scalar_first, const char* between) {
  const Eigen::Quaterniond q(pose.linear());
  char text[160];
  if (scalar_first) {
    std::snprintf(text, sizeof text, "%.17g%s%.17g%s%.17g%s%.17g", q.w(), between, q.x(), between, q.y(), between,
                  q.z());
  } else {
    std::snprintf(text, sizeof text, "%.17g%s%.17g%s%.17g%s%.17g", q.x(), between, q.y(), between, q.z(), between,
                  q.w());
  }
  return text;
}

/// KITTI odometry: sequences/NN/velodyne and times, poses/NN.txt in the frame of a camera that is the sensor's.
inline void write_kitti_layout(const fs::path& root, const std::vector<pair_sets::Drive>& drives) {
  for (const pair_sets::Drive& drive : drives) {
    char sequence[8];
    std::snprintf(sequence, sizeof sequence, "%02d", drive.session);
    const fs::path folder = root / "sequences" / sequence;
    fs::create_directories(folder / "velodyne");
    std::string times;
    for (std::size_t i = 0; i < drive.size(); ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "%06zu.bin", i);
      io::write_bin(folder / "velodyne" / name, drive.load(i));
      times += std::to_string(drive.stamps_s[i]) + "\n";
    }
    write_text(folder / "times.txt", times);
    write_text(folder / "calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
    write_text(root / "poses" / (std::string(sequence) + ".txt"), io::kitti_text(drive.T_world_cloud));
  }
}

/// Apollo-SouthBay: pcds and poses of one drive of the test set, frames from 1.
inline void write_apollo_layout(const fs::path& root, const pair_sets::Drive& drive) {
  const fs::path folder = root / "TestData/HighWay237/2018-10-12";
  fs::create_directories(folder / "pcds");
  std::string poses;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    io::write_pcd(folder / "pcds" / (std::to_string(i + 1) + ".pcd"), drive.load(i));
    const Eigen::Vector3d t = drive.T_world_cloud[i].translation();
    char text[160];
    std::snprintf(text, sizeof text, "%zu %.6f %.17g %.17g %.17g ", i + 1, drive.stamps_s[i], t.x(), t.y(), t.z());
    poses += text + quaternion_text(drive.T_world_cloud[i], false, " ") + "\n";
  }
  write_text(folder / "poses/gt_poses.txt", poses);
}

/// nuScenes: one scene, every sweep a LIDAR_TOP record, the sensor's frame that of the car.
inline void write_nuscenes_layout(const fs::path& root, const pair_sets::Drive& drive) {
  const fs::path tables = root / "v1.0-mini";
  write_text(tables / "scene.json", R"([{"token":"s","name":"scene-0001","first_sample_token":"a0"}])");
  write_text(tables / "calibrated_sensor.json", R"([{"token":"c","translation":[0,0,0],"rotation":[1,0,0,0]}])");
  std::string sweeps, poses;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const std::string n = std::to_string(i);
    const std::string next = i + 1 < drive.size() ? "w" + std::to_string(i + 1) : "";
    const std::string previous = i > 0 ? "w" + std::to_string(i - 1) : "";
    char stamp[32];
    std::snprintf(stamp, sizeof stamp, "%.0f", 1.6e15 + 1e6 * drive.stamps_s[i]);
    const Eigen::Vector3d t = drive.T_world_cloud[i].translation();
    char translation[96];
    std::snprintf(translation, sizeof translation, "%.17g,%.17g,%.17g", t.x(), t.y(), t.z());
    sweeps += (i ? "," : "[") + std::string(R"({"token":"w)") + n + R"(","sample_token":"a)" + n +
              R"(","ego_pose_token":"e)" + n + R"(","calibrated_sensor_token":"c","timestamp":)" + stamp +
              R"(,"is_key_frame":)" + (i ? "false" : "true") + R"(,"filename":"sweeps/LIDAR_TOP/w)" + n +
              R"(.pcd.bin","prev":")" + previous + R"(","next":")" + next + "\"}";
    poses += (i ? "," : "[") + std::string(R"({"token":"e)") + n + R"(","rotation":[)" +
             quaternion_text(drive.T_world_cloud[i], true, ",") + R"(],"translation":[)" + translation + "]}";
    std::string bytes;
    for (const Eigen::Vector3f& p : drive.load(i).points) {
      const float values[5] = {p.x(), p.y(), p.z(), 1.0F, 0.0F};
      bytes.append(reinterpret_cast<const char*>(values), sizeof values);
    }
    write_text(root / "sweeps/LIDAR_TOP" / ("w" + n + ".pcd.bin"), bytes);
  }
  write_text(tables / "sample_data.json", sweeps + "]");
  write_text(tables / "ego_pose.json", poses + "]");
}

}  // namespace loopmark::test

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A whole run folder made without a log: a street driven there and back, odometry with a known drift, loops with known
/// truth and one that is wrong but believed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/places/place_descriptor.hpp"
#include "loopmark/registration/engine.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"
#include "loopmark/workflows/options.hpp"
#include "support/box_world.hpp"

namespace loopmark::testing_support {

/// 40 keyframes 4 m apart: 20 along the street, 20 back, 1 m beside; every scan is a keyframe but every fifth one.
struct SyntheticRun {
  static constexpr std::size_t kKeyframes = 40;
  std::vector<Pose> truth;  ///< of every scan
  std::vector<std::size_t> scan_of_keyframe;

  /// Writes the run. Loops join k(39 - i) to k(i), i = 0, 3, 6, right within 2 cm; k30-k8 is 6 m wrong.
  explicit SyntheticRun(const std::filesystem::path& path) {
    map_store::RunFolder folder = map_store::RunFolder::create(path);
    write_scans(folder);
    map_store::write_loop_records(
        folder, {loop(39, 0, 0.02), loop(36, 3, 0.02), loop(33, 6, 0.02), loop(30, 8, 6.0), withheld(28, 11)});
    write_keyframes(folder);
    storage::write_file_atomically(folder / "config.yaml", workflows::options_as_yaml(workflows::ProgramOptions()));
    std::vector<double> stamps(truth.size());
    io::write_tum(folder / "records/truth.tum", stamps, truth);
    io::write_tum(folder / "trajectory.tum", stamps, truth);
    storage::write_file_atomically(folder / "summary.json", "{\"compensation\": \"compensated already\"}\n");
    storage::write_file_atomically(folder / "timings.json", "{\"whole\": 12.0}\n");
    storage::write_file_atomically(folder / "cloud.ply", "old");
    storage::write_file_atomically(folder / "manifest.json", "{\"input\": {\"log\": \"somewhere\"}, \"sha256\": {}}\n");
    folder.finish();
  }

  Pose true_motion(std::size_t source, std::size_t target) const {
    return truth[scan_of_keyframe[target]].inverse() * truth[scan_of_keyframe[source]];
  }

 private:
  static Pose place(std::size_t keyframe) {
    const bool back = keyframe >= kKeyframes / 2;
    const double x = 4.0 * static_cast<double>(back ? kKeyframes - 1 - keyframe : keyframe);
    return pose_from_yaw(back ? M_PI : 0.0, {x, back ? 1.0 : 0.0, 1.8});
  }

  void write_scans(const map_store::RunFolder& folder) {
    storage::RecordWriter file(folder.scan_records());
    Pose T_segment_lidar = Pose::Identity();
    for (std::size_t k = 0; k < kKeyframes; ++k) {
      if (k > 0) {  // odometry turns 0.15 degrees too far a keyframe
        T_segment_lidar = T_segment_lidar * place(k - 1).inverse() * place(k) * pose_from_yaw(0.15 * M_PI / 180.0);
      }
      add(file, place(k), T_segment_lidar, k);
      if (k % 5 == 4) {
        add(file, place(k), T_segment_lidar, std::nullopt);
      }
    }
  }

  void add(storage::RecordWriter& file, const Pose& true_pose, const Pose& T_segment_lidar,
           std::optional<std::size_t> keyframe) {
    map_store::ScanRecord record;
    record.scan = truth.size();
    record.stamp_s = 0.5 * static_cast<double>(truth.size());
    record.keyframe = keyframe;
    record.T_segment_lidar = T_segment_lidar;
    record.inlier_share = 0.9;
    record.covariance = 1e-6 * Matrix6d::Identity();
    file.append(to_line(record));
    if (keyframe) {
      scan_of_keyframe.push_back(truth.size());
    }
    truth.push_back(true_pose);
  }

  map_store::LoopRecord loop(std::size_t source, std::size_t target, double off_m) const {
    map_store::LoopRecord record;
    record.source = source;
    record.target = target;
    record.origin = "place";
    record.answered = true;
    record.p_correct = 0.97;
    record.T_target_source = pose_from_yaw(0.0, {off_m, 0.0, 0.0}) * true_motion(source, target);
    record.covariance = 1e-4 * Matrix6d::Identity();
    record.evidence = {{"agreement", 0.8}};
    return record;
  }

  map_store::LoopRecord withheld(std::size_t source, std::size_t target) const {
    map_store::LoopRecord record = loop(source, target, 0.0);
    record.answered = false;
    record.p_correct = 0.2;
    record.reason = "two answers are alike";
    return record;
  }

  void write_keyframes(const map_store::RunFolder& folder) const {
    const BoxWorld world = street(80.0, 3);
    for (std::size_t k = 0; k < kKeyframes; ++k) {
      const PointCloud seen = sweep(world, place(k), Vector6d::Zero(), 0.01, k);
      const PointCloud thin = cloud::voxel_downsampled(seen, 0.2);
      PointCloud kept;
      kept.points = thin.points;
      io::write_pcd(folder.keyframe(k, "pcd"), kept);
      storage::write_file_atomically(folder.keyframe(k, "place"), places::place_descriptor(thin.points).to_bytes());
      storage::write_file_atomically(folder.keyframe(k, "prepared"), registration::prepare_scan(kept, {}).to_bytes());
    }
  }
};

}  // namespace loopmark::testing_support

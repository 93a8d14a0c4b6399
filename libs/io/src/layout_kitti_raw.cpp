// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// KITTI raw (Geiger et al., "Vision meets Robotics: The KITTI Dataset", IJRR 2013).
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "layout_parts.hpp"
#include "layouts.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

/// T_velo_imu of calib_imu_to_velo.txt: lines "R: 9 numbers" and "T: 3 numbers".
std::optional<Pose> read_calibration(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return std::nullopt;
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  const std::string text = storage::read_file(file);
  for (const std::string_view line : text::split_lines(text)) {
    const auto words = text::split_words(line);
    const bool rotation = !words.empty() && words[0] == "R:" && words.size() == 10;
    const bool translation = !words.empty() && words[0] == "T:" && words.size() == 4;
    for (int k = 0; k < (rotation ? 9 : translation ? 3 : 0); ++k) {
      const double value = text::parse_number(words[static_cast<std::size_t>(k) + 1]).value_or(std::nan(""));
      (rotation ? matrix(k / 3, k % 3) : matrix(k, 3)) = value;
    }
  }
  try {
    return rigid_from_matrix(matrix, 1e-2);
  } catch (const std::invalid_argument& problem) {
    throw InputError(file.string(), "", problem.what());
  }
}

/// T_world_imu of one line of oxts (latitude, longitude, altitude, roll, pitch, yaw), in metres by the Mercator
/// projection that the data set's development kit uses; `scale` is the cosine of the first latitude.
Pose pose_of_oxts(const std::vector<double>& v, double scale) {
  constexpr double kEarth_m = 6378137.0;
  constexpr double kRadians = std::numbers::pi / 180.0;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(scale * kEarth_m * v[1] * kRadians,
                                       scale * kEarth_m * std::log(std::tan((90.0 + v[0]) * kRadians / 2.0)), v[2]);
  pose.linear() = rotation_from_euler_degrees(Eigen::Vector3d(v[3], v[4], v[5]) / kRadians);
  return pose;
}

/// Poses from GPS and IMU, relative to the first; something that is missing becomes truth_problem.
void take_oxts(FileLogParts& parts, const fs::path& drive) {
  std::error_code error;
  if (!fs::is_directory(drive / "oxts" / "data", error)) {
    return;
  }
  const fs::path absolute = fs::absolute(drive, error).lexically_normal();
  const fs::path folder = absolute.has_filename() ? absolute : absolute.parent_path();
  const fs::path calibration_file = folder.parent_path() / "calib_imu_to_velo.txt";
  const std::optional<Pose> T_velo_imu = read_calibration(calibration_file);
  std::vector<Pose> poses;
  double scale = 0.0;
  for (const fs::path& scan : parts.files) {
    const fs::path file = drive / "oxts" / "data" / (scan.stem().string() + ".txt");
    const auto rows = fs::is_regular_file(file, error) ? text::read_number_rows(file) : std::vector<text::NumberRow>{};
    if (!T_velo_imu || rows.size() != 1 || rows[0].values.size() < 6) {
      parts.info.truth_problem =
          (T_velo_imu ? file : calibration_file).string() + ": not there, or not as expected; poses are not used";
      log(Severity::kWarning, parts.info.truth_problem);
      return;
    }
    parts.info.companions.push_back(file);
    scale = poses.empty() ? std::cos(rows[0].values[0] * std::numbers::pi / 180.0) : scale;
    poses.push_back(pose_of_oxts(rows[0].values, scale) * T_velo_imu->inverse());
  }
  for (const Pose& pose : poses) {
    parts.truth.push_back(poses.front().inverse() * pose);
  }
  parts.info.truth_given = true;
  parts.info.truth_source = (drive / "oxts").string();
}

}  // namespace

LogPointer open_kitti_raw(const fs::path& path, const LogOptions& options) {
  for (const fs::path& base : {path / "velodyne_points", path}) {
    std::error_code error;
    auto files = list_point_files(base / "data");
    if (files.empty() || (base == path && !fs::exists(base / "timestamps.txt", error))) {
      continue;
    }
    const fs::path drive = base == path ? path / ".." : path;
    FileLogParts parts = parts_of_files(std::move(files), base, options);
    parts.info.format = "kitti-raw";
    parts.info.path = path;
    parts.info.motion_compensated = false;
    if (!parts.info.sweep && options.rebuild_times == RebuildTimes::kAuto) {
      parts.info.sweep = cloud::SweepModel{};
    }
    take_stamps(parts, base / "timestamps.txt");
    take_truth(parts, drive / "poses.txt");
    if (!parts.info.truth_given) {
      take_oxts(parts, drive);
    }
    return std::make_unique<FileLog>(std::move(parts));
  }
  return nullptr;
}

}  // namespace loopmark::io::internal

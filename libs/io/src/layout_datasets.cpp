// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The layouts of single data sets: MulRan, Apollo-SouthBay.
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "layout_parts.hpp"
#include "layouts.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;
namespace {

/// Position of the Ouster in MulRan's base frame (the calibration published with the data set's player).
Pose mulran_T_base_lidar() {
  Pose T_base_lidar = Pose::Identity();
  T_base_lidar.linear() = rotation_from_euler_degrees({0.0001, 0.0003, 179.6654});
  T_base_lidar.translation() = Eigen::Vector3d(1.7042, -0.021, 1.8047);
  return T_base_lidar;
}

[[noreturn]] void throw_row(const fs::path& file, std::size_t line, std::size_t there, std::size_t needed) {
  throw InputError(file.string(), std::to_string(line),
                   std::to_string(there) + " numbers where " + std::to_string(needed) + " are needed");
}

/// global_pose.csv: nanoseconds and the 3x4 pose of the base in each row.
void take_mulran_truth(FileLogParts& parts, const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return;
  }
  std::vector<double> stamps;
  std::vector<Pose> poses;
  const Pose T_base_lidar = mulran_T_base_lidar();
  for (const text::NumberRow& row : text::read_number_rows(file, ',')) {
    if (row.values.size() != 13) {
      throw_row(file, row.line, row.values.size(), 13);
    }
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(row.values.data() + 1);
    stamps.push_back(row.values[0] * 1e-9);
    poses.push_back(rigid_from_matrix(matrix, 1e-2) * T_base_lidar);
  }
  take_truth_interpolated(parts, stamps, poses, file.string());
  parts.info.companions.push_back(file);
}

/// gt_poses.txt: number, stamp, x y z, qx qy qz qw of each scan.
void take_apollo_truth(FileLogParts& parts, const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    return;
  }
  std::vector<std::size_t> numbers;
  std::vector<double> stamps;
  std::vector<Pose> poses;
  for (const text::NumberRow& row : text::read_number_rows(file)) {
    const std::vector<double>& v = row.values;
    if (v.size() != 9) {
      throw_row(file, row.line, v.size(), 9);
    }
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(v[2], v[3], v[4]);
    pose.linear() = Eigen::Quaterniond(v[8], v[5], v[6], v[7]).normalized().toRotationMatrix();
    numbers.push_back(static_cast<std::size_t>(std::llround(v[0])));
    stamps.push_back(v[1]);
    poses.push_back(pose);
  }
  for (std::size_t i = 0; i < parts.files.size(); ++i) {
    const auto row = std::lower_bound(numbers.begin(), numbers.end(), parts.frame_numbers[i]);
    if (row == numbers.end() || *row != parts.frame_numbers[i]) {
      throw InputError(file.string(), "", "no pose for " + parts.files[i].filename().string());
    }
    const auto at = static_cast<std::size_t>(row - numbers.begin());
    parts.truth.push_back(poses[at]);
    parts.stamps_s[i] = stamps[at];
  }
  parts.info.truth_given = true;
  parts.info.truth_source = file.string();
  parts.info.stamps_given = true;
  parts.info.stamps_source = file.filename().string();
  parts.info.companions.push_back(file);
}

}  // namespace

LogPointer open_mulran(const fs::path& path, const LogOptions& options) {
  for (const fs::path& folder : {path / "Ouster", path / "sensor_data" / "Ouster"}) {
    auto files = list_point_files(folder);
    if (files.empty()) {
      continue;
    }
    FileLogParts parts = parts_of_files(std::move(files), path, options);
    parts.info.format = "mulran";
    parts.info.path = path;
    take_mulran_truth(parts, path / "global_pose.csv");
    return std::make_unique<FileLog>(std::move(parts));
  }
  return nullptr;
}

LogPointer open_apollo(const fs::path& path, const LogOptions& options) {
  auto files = list_point_files(path / "pcds");
  std::error_code error;
  if (files.empty() || !fs::exists(path / "poses", error)) {
    return nullptr;
  }
  FileLogParts parts = parts_of_files(std::move(files), path, options);
  parts.info.format = "apollo";
  parts.info.path = path;
  take_apollo_truth(parts, path / "poses" / "gt_poses.txt");
  return std::make_unique<FileLog>(std::move(parts));
}

}  // namespace loopmark::io::internal

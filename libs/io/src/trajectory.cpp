// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io {
namespace {

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Pose pose_from_tum(const std::vector<double>& v) {
  const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1.0) > 1e-2) {
    throw std::invalid_argument("the quaternion does not have length 1");
  }
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  pose.linear() = q.normalized().toRotationMatrix();
  return pose;
}

Pose pose_from_kitti(const std::vector<double>& v) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
  return rigid_from_matrix(matrix, 1e-2);  // files with few digits
}

}  // namespace

std::string tum_text(const std::vector<double>& stamps_s, const std::vector<Pose>& poses) {
  std::string text;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Eigen::Quaterniond q(poses[i].linear());
    if (q.w() < 0.0) {
      q.coeffs() *= -1.0;
    }
    text += number("%.6f", stamps_s.at(i));
    for (const double value : {poses[i].translation().x(), poses[i].translation().y(), poses[i].translation().z(),
                               q.x(), q.y(), q.z(), q.w()}) {
      text += number(" %.9f", value);
    }
    text += '\n';
  }
  return text;
}

void write_tum(const std::filesystem::path& path, const std::vector<double>& stamps_s, const std::vector<Pose>& poses) {
  storage::write_file_atomically(path, tum_text(stamps_s, poses));
}

std::string kitti_text(const std::vector<Pose>& poses) {
  std::string text;
  for (const Pose& pose : poses) {
    for (int k = 0; k < 12; ++k) {
      text += number(k == 0 ? "%.9e" : " %.9e", pose.matrix()(k / 4, k % 4));
    }
    text += '\n';
  }
  return text;
}

void write_kitti(const std::filesystem::path& path, const std::vector<Pose>& poses) {
  storage::write_file_atomically(path, kitti_text(poses));
}

Trajectory read_trajectory(const std::filesystem::path& path) {
  Trajectory trajectory;
  std::size_t columns = 0;
  for (const text::NumberRow& row : text::read_number_rows(path)) {
    const std::size_t width = row.values.size();
    if (width != 8 && width != 12) {
      throw InputError(path.string(), std::to_string(row.line),
                       std::to_string(width) + " numbers where 12 (KITTI) or 8 (TUM) are a pose");
    }
    if (columns != 0 && width != columns) {
      throw InputError(path.string(), std::to_string(row.line), "another number of columns than in the lines above");
    }
    columns = width;
    try {
      trajectory.poses.push_back(width == 12 ? pose_from_kitti(row.values) : pose_from_tum(row.values));
    } catch (const std::invalid_argument& error) {
      throw InputError(path.string(), std::to_string(row.line), error.what());
    }
    if (width == 8) {
      trajectory.stamps_s.push_back(row.values[0]);
    }
  }
  return trajectory;
}

Pose pose_at(const Trajectory& trajectory, double stamp_s) {
  const std::vector<double>& stamps = trajectory.stamps_s;
  const auto after = std::upper_bound(stamps.begin(), stamps.end(), stamp_s);
  if (after == stamps.begin()) {
    return trajectory.poses.front();
  }
  if (after == stamps.end()) {
    return trajectory.poses.back();
  }
  const auto i = static_cast<std::size_t>(after - stamps.begin());
  const double ratio = (stamp_s - stamps[i - 1]) / (stamps[i] - stamps[i - 1]);
  return interpolate(trajectory.poses[i - 1], trajectory.poses[i], ratio);
}

}  // namespace loopmark::io

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/text.hpp"

namespace loopmark::io {
namespace {

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
    text += format_text("%.6f", stamps_s.at(i));
    for (const double value : {poses[i].translation().x(), poses[i].translation().y(), poses[i].translation().z(),
                               q.x(), q.y(), q.z(), q.w()}) {
      text += format_text(" %.9f", value);
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
      text += format_text(k == 0 ? "%.9e" : " %.9e", pose.matrix()(k / 4, k % 4));
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

namespace {

constexpr double kSameTime_s = 0.002;  ///< of a pose and a scan: stamps are often rounded to milliseconds
constexpr double kFarthest_s = 0.5;    ///< between two poses that a scan's is interpolated from

Trajectory in_order_of_time(const Trajectory& trajectory) {
  std::vector<std::size_t> order(trajectory.poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return trajectory.stamps_s[a] < trajectory.stamps_s[b]; });
  Trajectory sorted;
  for (const std::size_t i : order) {
    sorted.stamps_s.push_back(trajectory.stamps_s[i]);
    sorted.poses.push_back(trajectory.poses[i]);
  }
  return sorted;
}

/// Whether there is a pose for each scan, in their order, at its time: of several sessions in one run the times
/// overlap, and time alone would not tell them apart.
bool one_for_each(const std::vector<double>& poses_s, const std::vector<double>& scans_s) {
  return std::equal(poses_s.begin(), poses_s.end(), scans_s.begin(), scans_s.end(),
                    [](double a, double b) { return std::abs(a - b) <= kSameTime_s; });
}

/// Whether the poses, whose stamps rise, say where the sensor was at a time.
bool covers(const Trajectory& sorted, double stamp_s) {
  const std::vector<double>& stamps = sorted.stamps_s;
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp_s);
  if (after != stamps.end() && *after - stamp_s <= kSameTime_s) {
    return true;
  }
  if (after == stamps.begin()) {
    return false;
  }
  const double before_s = *(after - 1);
  return stamp_s - before_s <= kSameTime_s || (after != stamps.end() && *after - before_s <= kFarthest_s);
}

std::string range_text(const std::vector<double>& stamps_s) {
  const auto [first, last] = std::minmax_element(stamps_s.begin(), stamps_s.end());
  return format_text("%.3f", *first) + " to " + format_text("%.3f", *last) + " s";
}

}  // namespace

std::vector<Pose> poses_of_scans(const Trajectory& trajectory, const std::vector<double>& stamps_s,
                                 const std::string& source) {
  if (trajectory.poses.empty()) {
    throw InputError(source, "", "holds no pose",
                     "one pose a scan is needed, in lines of 8 (TUM) or 12 numbers (KITTI)");
  }
  if (trajectory.stamps_s.empty()) {
    if (trajectory.poses.size() != stamps_s.size()) {
      throw InputError(
          source, "",
          std::to_string(trajectory.poses.size()) + " poses for " + std::to_string(stamps_s.size()) + " scans",
          "poses without times must be one for each scan; poses with times (TUM) are joined by time");
    }
    return trajectory.poses;
  }
  if (one_for_each(trajectory.stamps_s, stamps_s)) {
    return trajectory.poses;
  }
  const Trajectory sorted = in_order_of_time(trajectory);
  std::vector<Pose> poses;
  for (const double stamp_s : stamps_s) {
    if (covers(sorted, stamp_s)) {
      poses.push_back(pose_at(sorted, stamp_s));
    }
  }
  if (poses.size() != stamps_s.size()) {
    throw InputError(source, "",
                     "only " + std::to_string(poses.size()) + " of " + std::to_string(stamps_s.size()) +
                         " scans have a pose at their time; poses from " + range_text(sorted.stamps_s) +
                         ", scans from " + range_text(stamps_s),
                     "the poses must have the clock of the scans, reach from the first to the last, and follow each "
                     "other within 0.5 s");
  }
  return poses;
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
  const double ratio = (stamp_s - stamps[i - 1]) / (stamps[i] - stamps[i - 1]);  // upper_bound: never 0 / 0
  return interpolate(trajectory.poses[i - 1], trajectory.poses[i], ratio);
}

}  // namespace loopmark::io

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/world_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "loopmark/odometry/odometry.hpp"

namespace loopmark::odometry {
namespace {

constexpr std::size_t kSectors = 36;
constexpr std::size_t kLeastSectors = 6;  ///< that hold points of both scans
constexpr double kLeastChange_m = 0.5;    ///< of the blind spot
constexpr double kMostMotion_m = 0.3;     ///< between scans that stand in one frame
constexpr double kMostShare = 0.25;       ///< of that motion in the change of the blind spot

using Ranges = std::array<double, kSectors>;

Ranges nearest_ranges(const PointCloud& cloud) {
  Ranges nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  for (const Eigen::Vector3f& p : cloud.points) {
    const double azimuth = std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x()));
    const auto sector = static_cast<std::size_t>((azimuth / (2.0 * M_PI) + 0.5) * static_cast<double>(kSectors));
    double& range = nearest[std::min(sector, kSectors - 1)];
    range = std::min(range, static_cast<double>(p.head<2>().norm()));
  }
  return nearest;
}

}  // namespace

double blind_spot_change(const PointCloud& before, const PointCloud& now) {
  const Ranges a = nearest_ranges(before);
  const Ranges b = nearest_ranges(now);
  std::vector<double> changes;
  for (std::size_t k = 0; k < kSectors; ++k) {
    if (std::isfinite(a[k]) && std::isfinite(b[k])) {
      changes.push_back(std::abs(a[k] - b[k]));
    }
  }
  if (changes.size() < kLeastSectors) {
    return -1.0;
  }
  const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 2);
  std::nth_element(changes.begin(), middle, changes.end());
  return *middle;
}

FrameFinding find_world_frame(const std::vector<std::size_t>& window, const std::function<Scan(std::size_t)>& read) {
  FrameFinding finding;
  if (window.size() < 2) {
    return finding;
  }
  finding.blind_spot_m = blind_spot_change(read(window.front()).cloud, read(window.back()).cloud);
  if (finding.blind_spot_m < kLeastChange_m) {
    return finding;
  }
  OdometryOptions options;
  options.min_range_m = 0.1;
  options.max_range_m = 1e4;
  Odometry odometry(options, Compensation::kCompensated);
  bool followed = true;
  Pose first = Pose::Identity();
  for (const std::size_t i : window) {
    const TrackedScan tracked = odometry.track(read(i));
    odometry.commit(tracked);
    first = i == window.front() ? tracked.T_map_lidar : first;
    finding.motion_m = (tracked.T_map_lidar.translation() - first.translation()).norm();
    followed = followed && tracked.tracking_status.tracking != Tracking::kLost;
  }
  finding.in_world_frame = followed && finding.motion_m < std::min(kMostMotion_m, kMostShare * finding.blind_spot_m);
  return finding;
}

}  // namespace loopmark::odometry

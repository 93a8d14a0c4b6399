// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/map_truth.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

namespace loopmark::mapping {

MapTruth::MapTruth(std::vector<Pose> T_map_scan, std::vector<Pose> T_world_scan)
    : T_map_scan_(std::move(T_map_scan)), T_world_scan_(std::move(T_world_scan)) {
  if (T_map_scan_.size() != T_world_scan_.size() || T_map_scan_.empty()) {
    throw std::invalid_argument("the map's truth needs one pose for each of its scans");
  }
}

std::size_t MapTruth::nearest(const Pose& T_world_lidar) const {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < T_world_scan_.size(); ++i) {
    const double squared = (T_world_scan_[i].translation() - T_world_lidar.translation()).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  return nearest;
}

PoseError MapTruth::error(const Pose& T_map_lidar, const Pose& T_world_lidar) const {
  const std::size_t near = nearest(T_world_lidar);
  return pose_error(T_map_scan_[near].inverse() * T_map_lidar, T_world_scan_[near].inverse() * T_world_lidar);
}

Pose MapTruth::in_map(const Pose& T_world_lidar) const {
  const std::size_t near = nearest(T_world_lidar);
  return T_map_scan_[near] * T_world_scan_[near].inverse() * T_world_lidar;
}

double MapTruth::distance(const Pose& T_world_lidar) const {
  return (T_world_scan_[nearest(T_world_lidar)].translation() - T_world_lidar.translation()).norm();
}

}  // namespace loopmark::mapping

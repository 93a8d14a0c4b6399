// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::mapping {

/// What is known of a map's scans besides the map: with it an answer in the map is compared with the truth in the world
/// through the nearest scan of the map, so that the map's drift elsewhere does not count.
class MapTruth {
 public:
  /// One pose of each for every scan of the map. Throws std::invalid_argument when there are none or their numbers
  /// differ.
  MapTruth(std::vector<Pose> T_map_scan, std::vector<Pose> T_world_scan);

  /// T_map_near^-1 * answer against T_world_near^-1 * truth.
  PoseError error(const Pose& T_map_lidar, const Pose& T_world_lidar) const;

  /// Where the truth is in the map, through the same scan.
  Pose in_map(const Pose& T_world_lidar) const;

  /// Metres from a true position to the nearest scan of the map.
  double distance(const Pose& T_world_lidar) const;

 private:
  std::size_t nearest(const Pose& T_world_lidar) const;

  std::vector<Pose> T_map_scan_;
  std::vector<Pose> T_world_scan_;
};

}  // namespace loopmark::mapping

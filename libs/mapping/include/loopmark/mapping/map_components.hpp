// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The parts of a map that nothing joins, by name.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::mapping {

/// A part of the map with a frame of its own. The first, "main", is the map; poses of the others ("component_1", ...)
/// say nothing about where they stand in it.
struct MapComponent {
  std::string name;
  bool anchored = false;  ///< holds the keyframe that the map's frame hangs on
  std::size_t scans = 0;
  std::size_t first_scan = 0;  ///< places in the log
  std::size_t last_scan = 0;
  double begin_s = 0.0;  ///< their stamps
  double end_s = 0.0;
  std::size_t segments = 0;  ///< that odometry drove without a break
  std::size_t keyframes = 0;
  double path_m = 0.0;         ///< driven in it
  std::size_t candidates = 0;  ///< loops tried between it and the others
  double best_p = 0.0;         ///< the largest P(correct) among them,
  std::string best;            ///< and that pair, "1530-12: too few links"; empty when nothing was tried
};

/// "main", "component_1", ...
std::string component_name(std::size_t component);

/// One for each of map.components, in order.
std::vector<MapComponent> map_components(const std::vector<map_store::ScanRecord>& scans,
                                         const std::vector<map_store::LoopRecord>& loops, const SolvedMap& map);

}  // namespace loopmark::mapping

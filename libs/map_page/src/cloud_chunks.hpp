// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The cloud of a page: chunks of consecutive keyframes, their points thinned and ordered from coarse to fine, so that
/// the page draws as many of each as can be told apart.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::map_page::internal {

/// Voxels of the levels of detail, metres: at most one point in each. Every third is half as large.
constexpr std::array<double, 16> kLevelVoxel_m = {6.4,   5.08, 4.032, 3.2,   2.54, 2.016, 1.6,   1.27,
                                                  1.008, 0.8,  0.635, 0.504, 0.4,  0.317, 0.252, 0.2};
/// Coordinates are whole multiples of this in the keyframe's frame, unless a point is farther than 32767 of them.
constexpr double kRounded_m = 0.02;

struct Chunk {
  std::size_t first = 0;  ///< keyframe
  std::size_t keyframes = 0;
  std::vector<std::size_t> levels;  ///< points up to and with each level
  double scale_m = kRounded_m;
  double reach_m = 0.0;
  std::string blocks;  ///< of the page: the points
};

struct ChunkedCloud {
  std::vector<Chunk> chunks;
  std::size_t points = 0;
  std::size_t of = 0;                            ///< points at the finest level there is
  std::size_t levels = kLevelVoxel_m.size();     ///< that fit
  std::array<double, 2> height_m = {0.0, 1.0};   ///< 2nd and 98th percentile, in the map
  std::array<double, 2> intensity = {0.0, 0.0};  ///< likewise; equal where the scans have none
};

using KeyframeCloud = std::function<PointCloud(std::size_t)>;

ChunkedCloud chunked_cloud(const mapping::SolvedMap& map, const KeyframeCloud& keyframe_cloud, std::size_t max_points);

}  // namespace loopmark::map_page::internal

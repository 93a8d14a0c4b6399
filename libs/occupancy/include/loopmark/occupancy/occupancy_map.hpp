// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// OctoMap (Hornung et al., Autonomous Robots 2013) of many scans: the same voxels, log-odds and files as one
/// octomap::OcTree::insertPointCloud a scan would give, built many times faster and in bounded memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/occupancy/occupancy_options.hpp"

namespace loopmark::occupancy {

struct OccupancyStatistics {
  std::size_t scans = 0;
  std::size_t rays = 0;
  std::size_t skipped_points = 0;  ///< not finite, or outside the 65536 voxels an octree spans
  std::size_t tiles = 0;           ///< cubes of 128 voxels that hold anything
  std::size_t spilled_tiles = 0;   ///< times a tile was moved to the disk
  std::size_t nodes = 0;           ///< of the tree in map.ot, inner ones included
};

/// Takes scans one at a time, keeps what is near in memory, and writes the map at the end.
class OccupancyMapBuilder {
 public:
  /// `scratch_folder` must exist; files made there are removed again.
  OccupancyMapBuilder(const OccupancyOptions& options, const std::filesystem::path& scratch_folder);
  ~OccupancyMapBuilder();
  OccupancyMapBuilder(const OccupancyMapBuilder&) = delete;
  OccupancyMapBuilder& operator=(const OccupancyMapBuilder&) = delete;

  /// Adds one scan: points in the sensor's frame (metres), rays from the sensor's origin. Scans act in the order in
  /// which they are inserted. Throws InputError when the sensor stands outside what an octree spans.
  void insert(const std::vector<Eigen::Vector3f>& points, const Pose& T_map_sensor);

  /// Writes the maximum-likelihood map (.bt: free, occupied) and the full one (.ot: log-odds), pruned, each whole or
  /// not at all. An empty path leaves that file out. Throws InputError when they cannot be written.
  OccupancyStatistics write(const std::filesystem::path& bt, const std::filesystem::path& ot);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace loopmark::occupancy

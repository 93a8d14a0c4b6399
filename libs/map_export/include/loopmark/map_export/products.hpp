// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a run leaves behind for people and programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "loopmark/mapping/mapper.hpp"
#include "loopmark/occupancy/occupancy_map.hpp"

namespace loopmark::map_export {

/// trajectory.tum, trajectory.kitti, covariances.csv, loops.csv, components.csv, pose_graph.g2o. The trajectories hold
/// a pose for every scan; where the map has several components, trajectory.tum says so in a comment, and each but the
/// first has a trajectory of its own (component_1.tum, ...), in a frame of its own.
void write_trajectory_products(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                               const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map);

/// map.bt, map.ot: the occupancy of the first component.
occupancy::OccupancyStatistics write_occupancy(const map_store::RunFolder& folder, const mapping::SolvedMap& map,
                                               const occupancy::OccupancyOptions& options);

/// cloud.ply: the points of the first component, one a voxel, coloured by height. component_1.ply, ...: those of
/// segments that found no place in it.
void write_clouds(const map_store::RunFolder& folder, const mapping::SolvedMap& map, double voxel_m);

/// map.simplemap and map.3Dscene for MRPT's tools: the first component. The scene shows one point a voxel of 0.5 m, of
/// larger voxels where these would be over a million.
void write_mrpt_products(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                         const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map);

/// What stands in manifest.json besides the outputs' hashes.
struct Manifest {
  std::vector<std::string> arguments;  ///< of the program, but its name
  std::string log;                     ///< path of the input
  std::string input_sha256;            ///< of records/inputs.sha256, which has a line of sha256sum for each file read
  std::string started;                 ///< ISO 8601, UTC
  double seconds = 0.0;                ///< of this process
  int exit_status = 0;
  std::map<std::string, std::string> known_sha256 = {};  ///< of files known not to have changed, by path in the run
  std::size_t input_files = 0;                           ///< lines of records/inputs.sha256
  std::uint64_t input_bytes = 0;                         ///< of those files
  std::vector<std::vector<std::string>> resumed = {};    ///< arguments of the processes that went on with the run
  std::string problem = {};                              ///< why the run ended before it was whole
};

/// The input as the manifest of another run names it: log, input_sha256, input_files, input_bytes. Throws InputError.
Manifest input_of_manifest(const map_store::RunFolder& folder);

/// manifest.json: version, arguments, times, exit status, and the SHA-256 of every file of the run but itself. Of a run
/// that has a problem the files are not whole, and their hashes are left out.
void write_manifest(const map_store::RunFolder& folder, const Manifest& manifest);

}  // namespace loopmark::map_export

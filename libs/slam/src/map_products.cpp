// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/mrpt_bridge/map_export.hpp"
#include "loopmark/occupancy/occupancy_map.hpp"
#include "loopmark/slam/products.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kMain = 0;

std::vector<std::size_t> keyframes_in(const SolvedMap& map, std::size_t component) {
  std::vector<std::size_t> result;
  for (const Keyframe& keyframe : map.keyframes) {
    if (map.solution.component_of[keyframe.number] == component) {
      result.push_back(keyframe.number);
    }
  }
  return result;
}

/// Blue (low) over green to red (high), between -2 m and 10 m above the first scan.
Rgb height_colour(float z) {
  const float ratio = std::clamp((z + 2.0F) / 12.0F, 0.0F, 1.0F);
  const auto channel = [](float value) {
    return static_cast<std::uint8_t>(255.0F * std::clamp(value, 0.0F, 1.0F) + 0.5F);
  };
  return {channel(2.0F * ratio - 0.5F), channel(1.4F - std::abs(2.8F * ratio - 1.2F)), channel(1.3F - 2.2F * ratio)};
}

/// The points of one component in the map's frame, one a voxel.
PointCloud joined(const RunFolder& folder, const SolvedMap& map, std::size_t component, double voxel_m) {
  constexpr std::size_t kThinEvery = 20;
  PointCloud cloud;
  std::size_t added = 0;
  for (const std::size_t number : keyframes_in(map, component)) {
    const PointCloud moved = transformed(read_keyframe_cloud(folder, number), map.T_map_keyframe[number]);
    if (cloud.empty()) {
      cloud = moved;
    } else {
      append(cloud, moved);
    }
    if (++added % kThinEvery == 0) {
      cloud = voxel_downsampled(cloud, voxel_m);
    }
  }
  return voxel_downsampled(cloud, voxel_m);
}

std::vector<Rgb> colours(const PointCloud& cloud) {
  std::vector<Rgb> result(cloud.size());
  std::transform(cloud.points.begin(), cloud.points.end(), result.begin(),
                 [](const Eigen::Vector3f& p) { return height_colour(p.z()); });
  return result;
}

}  // namespace

OccupancyStatistics write_occupancy(const RunFolder& folder, const SolvedMap& map, const OccupancyOptions& options) {
  const std::filesystem::path scratch = folder / "records/scratch";
  std::filesystem::remove_all(scratch);  // what a killed run may have left
  std::filesystem::create_directory(scratch);
  OccupancyMapBuilder builder(options, scratch);
  for (const std::size_t number : keyframes_in(map, kMain)) {
    builder.insert(read_keyframe_cloud(folder, number).points, map.T_map_keyframe[number]);
  }
  const OccupancyStatistics statistics = builder.write(folder / "map.bt", folder / "map.ot");
  std::filesystem::remove_all(scratch);
  return statistics;
}

void write_clouds(const RunFolder& folder, const SolvedMap& map, double voxel_m) {
  for (std::size_t component = 0; component < map.components; ++component) {
    const PointCloud cloud = joined(folder, map, component, voxel_m);
    const std::string file = component == kMain ? "cloud.ply" : "component_" + std::to_string(component) + ".ply";
    write_ply(folder / file, cloud, colours(cloud));
  }
}

void write_mrpt_products(const RunFolder& folder, const std::vector<ScanRecord>& scans,
                         const std::vector<LoopRecord>& loops, const SolvedMap& map) {
  const std::vector<std::size_t> numbers = keyframes_in(map, kMain);
  write_simplemap(folder / "map.simplemap", numbers.size(), [&](std::size_t i) {
    const Keyframe& keyframe = map.keyframes[numbers[i]];
    const ScanRecord& scan = scans[keyframe.scan];
    return SimpleMapKeyframe{map.T_map_keyframe[numbers[i]], map.covariance[keyframe.scan],
                             Scan{scan.scan, scan.stamp_s, read_keyframe_cloud(folder, numbers[i])}};
  });
  constexpr double kSceneVoxel = 0.5;
  SceneContent scene;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (map.component[i] == kMain) {
      scene.trajectory.push_back(map.T_map_scan[i]);
    }
  }
  std::vector<std::size_t> place_of_scan(scans.size(), 0);
  for (std::size_t i = 0, place = 0; i < scans.size(); ++i) {
    place_of_scan[i] = map.component[i] == kMain ? place++ : 0;
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::size_t source = map.keyframes[loops[i].source].scan;
    const std::size_t target = map.keyframes[loops[i].target].scan;
    if (map.loops[i].accepted && map.component[source] == kMain && map.component[target] == kMain) {
      scene.loops.push_back({place_of_scan[source], place_of_scan[target]});
    }
  }
  const PointCloud cloud = joined(folder, map, kMain, kSceneVoxel);
  scene.points = cloud.points;
  scene.colours = colours(cloud);
  write_scene(folder / "map.3Dscene", scene);
}

}  // namespace loopmark

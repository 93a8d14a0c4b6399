// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "loopmark/cloud/thin_cloud.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/mrpt_bridge/map_export.hpp"
#include "loopmark/occupancy/occupancy_map.hpp"

namespace loopmark::map_export {
namespace {

constexpr std::size_t kMain = 0;
constexpr double kSceneVoxel_m = 0.5;
constexpr std::size_t kScenePoints = 1'000'000;  // more make voxels larger: the scene is to be looked at, and held

std::vector<std::size_t> keyframes_in(const mapping::SolvedMap& map, std::size_t component) {
  std::vector<std::size_t> result;
  for (const mapping::Keyframe& keyframe : map.keyframes) {
    if (map.solution.component_of[keyframe.number] == component) {
      result.push_back(keyframe.number);
    }
  }
  return result;
}

/// Blue (low) over green to red (high), between -2 m and 10 m above the first scan.
io::Rgb height_colour(float z) {
  const float ratio = std::clamp((z + 2.0F) / 12.0F, 0.0F, 1.0F);
  const auto channel = [](float value) {
    return static_cast<std::uint8_t>(255.0F * std::clamp(value, 0.0F, 1.0F) + 0.5F);
  };
  return {channel(2.0F * ratio - 0.5F), channel(1.4F - std::abs(2.8F * ratio - 1.2F)), channel(1.3F - 2.2F * ratio)};
}

PointCloud in_map(const map_store::RunFolder& folder, const mapping::SolvedMap& map, std::size_t number) {
  return transformed(map_store::read_keyframe_cloud(folder, number), map.T_map_keyframe[number]);
}

std::vector<io::Rgb> colours(const std::vector<Eigen::Vector3f>& points) {
  std::vector<io::Rgb> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(),
                 [](const Eigen::Vector3f& p) { return height_colour(p.z()); });
  return result;
}

/// What MRPT's SceneViewer3D shows of the first component, whose keyframes are `numbers`.
mrpt_bridge::SceneContent scene_of(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                                   const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map,
                                   const std::vector<std::size_t>& numbers) {
  mrpt_bridge::SceneContent scene;
  std::vector<std::size_t> place_of_scan(scans.size(), 0);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (map.component[i] == kMain) {
      place_of_scan[i] = scene.trajectory.size();
      scene.trajectory.push_back(map.T_map_scan[i]);
    }
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::size_t source = map.keyframes[loops[i].source].scan;
    const std::size_t target = map.keyframes[loops[i].target].scan;
    if (map.loops[i].accepted && map.component[source] == kMain && map.component[target] == kMain) {
      scene.loops.push_back({place_of_scan[source], place_of_scan[target]});
    }
  }
  cloud::OverviewCloud cloud(kSceneVoxel_m, kScenePoints);
  for (const std::size_t number : numbers) {
    cloud.add(in_map(folder, map, number).points);
  }
  scene.points = cloud.points();
  scene.colours = colours(scene.points);
  return scene;
}

/// A folder of the run for what waits on the disk; what a killed run may have left in it is gone.
class ScratchFolder {
 public:
  explicit ScratchFolder(const map_store::RunFolder& folder) : path_(folder / "records/scratch") {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
    std::filesystem::create_directory(path_, error);
    if (error) {
      throw InputError(path_.string(), "", "cannot be made: " + error.message(), "check the disk's space");
    }
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

occupancy::OccupancyStatistics write_occupancy(const map_store::RunFolder& folder, const mapping::SolvedMap& map,
                                               const occupancy::OccupancyOptions& options) {
  const ScratchFolder scratch(folder);
  occupancy::OccupancyMapBuilder builder(options, scratch.path());
  const std::vector<std::size_t> numbers = keyframes_in(map, kMain);
  Progress progress("occupancy", "keyframes", numbers.size());
  for (const std::size_t number : numbers) {
    builder.insert(map_store::read_keyframe_cloud(folder, number).points, map.T_map_keyframe[number]);
    progress.add();
  }
  return builder.write(folder / "map.bt", folder / "map.ot");
}

void write_clouds(const map_store::RunFolder& folder, const mapping::SolvedMap& map, double voxel_m) {
  const ScratchFolder scratch(folder);
  Progress progress("cloud", "keyframes", map.keyframes.size());
  for (std::size_t component = 0; component < map.components; ++component) {
    cloud::TiledCloud cloud(voxel_m, scratch.path() / "cloud");
    for (const std::size_t number : keyframes_in(map, component)) {
      cloud.add(in_map(folder, map, number));
      progress.add();
    }
    const std::string file = component == kMain ? "cloud.ply" : "component_" + std::to_string(component) + ".ply";
    io::write_ply_in_parts(folder / file, cloud.size(), [&](const io::PlyPart& add) {
      cloud.for_each_tile([&](const PointCloud& tile) { add(tile, colours(tile.points)); });
    });
  }
}

void write_mrpt_products(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                         const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map) {
  const std::vector<std::size_t> numbers = keyframes_in(map, kMain);
  Progress progress("files for MRPT", "keyframes", numbers.size());
  mrpt_bridge::write_simplemap(folder / "map.simplemap", numbers.size(), [&](std::size_t i) {
    const mapping::Keyframe& keyframe = map.keyframes[numbers[i]];
    const map_store::ScanRecord& scan = scans[keyframe.scan];
    progress.add();
    return mrpt_bridge::SimpleMapKeyframe{
        map.T_map_keyframe[numbers[i]], map.covariance[keyframe.scan],
        Scan{scan.scan, scan.stamp_s, map_store::read_keyframe_cloud(folder, numbers[i])}};
  });
  mrpt_bridge::write_scene(folder / "map.3Dscene", scene_of(folder, scans, loops, map, numbers));
}

}  // namespace loopmark::map_export

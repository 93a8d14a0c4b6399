// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/keyframe_files.hpp"

#include <algorithm>

#include "loopmark/bev/ground_alignment.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::map_store {
namespace {

std::vector<Eigen::Vector3f> levelled(const PointCloud& cloud) {
  return transformed(cloud, bev::find_ground_alignment(cloud.points).T_level_sensor).points;
}

}  // namespace

void write_keyframe_cloud(const RunFolder& folder, std::size_t number, const PointCloud& cloud) {
  PointCloud kept;
  kept.points = cloud.points;
  kept.intensity = cloud.intensity;
  io::write_pcd(folder.keyframe(number, "pcd"), kept);
}

PointCloud read_keyframe_cloud(const RunFolder& folder, std::size_t number) {
  return io::read_point_file(folder.keyframe(number, "pcd")).cloud;
}

places::PlaceDescriptor place_of(const PointCloud& cloud) { return places::place_descriptor(levelled(cloud)); }

void write_keyframe_place(const RunFolder& folder, std::size_t number, const PointCloud& cloud) {
  storage::write_file_atomically(folder.keyframe(number, "place"), place_of(cloud).to_bytes());
}

places::PlaceDescriptor read_keyframe_place(const RunFolder& folder, std::size_t number) {
  const std::filesystem::path file = folder.keyframe(number, "place");
  const std::string bytes = storage::read_file(file);
  if (places::PlaceDescriptor::is_outdated(bytes)) {
    return place_of(read_keyframe_cloud(folder, number));
  }
  try {
    places::PlaceDescriptor descriptor = places::PlaceDescriptor::from_bytes(bytes);
    places::require_sound(descriptor, places::PlaceOptions{});
    return descriptor;
  } catch (const InputError& error) {
    throw InputError(file.string(), "", error.what(), "copy it again, or map its log again");
  }
}

void keep_records(const std::filesystem::path& path, std::size_t count) {
  const storage::RecordLines records = storage::read_sound_records(path);
  if (records.lines.size() <= count && !records.damaged) {
    return;
  }
  const std::string content = storage::read_file(path);
  std::size_t end = 0;
  for (std::size_t i = 0; i < std::min(count, records.lines.size()); ++i) {
    end = content.find('\n', end) + 1;
  }
  storage::write_file_atomically(path, std::string_view(content).substr(0, end));
}

}  // namespace loopmark::map_store

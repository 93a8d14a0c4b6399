// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "keyframe_files.hpp"

#include "loopmark/birdseye/levelling.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/core/record_file.hpp"
#include "loopmark/io/point_files.hpp"

namespace loopmark {
namespace {

std::vector<Eigen::Vector3f> levelled(const PointCloud& cloud) {
  return transformed(cloud, birdseye::find_levelling(cloud.points).T_level_sensor).points;
}

}  // namespace

void write_keyframe_cloud(const RunFolder& folder, std::size_t number, const PointCloud& cloud) {
  PointCloud kept;
  kept.points = cloud.points;
  kept.intensity = cloud.intensity;
  write_pcd(folder.keyframe(number, "pcd"), kept);
}

PointCloud read_keyframe_cloud(const RunFolder& folder, std::size_t number) {
  return read_point_file(folder.keyframe(number, "pcd")).cloud;
}

PlaceSignature place_of(const PointCloud& cloud) { return place_signature(levelled(cloud)); }

void write_keyframe_place(const RunFolder& folder, std::size_t number, const PointCloud& cloud) {
  write_file_atomically(folder.keyframe(number, "place"), place_of(cloud).to_bytes());
}

PlaceSignature read_keyframe_place(const RunFolder& folder, std::size_t number) {
  const std::string bytes = read_file(folder.keyframe(number, "place"));
  return PlaceSignature::is_outdated(bytes) ? place_of(read_keyframe_cloud(folder, number))
                                            : PlaceSignature::from_bytes(bytes);
}

void keep_records(const std::filesystem::path& path, std::size_t count) {
  const RecordLines records = read_records(path);
  if (records.lines.size() <= count) {
    return;
  }
  const std::string content = read_file(path);
  std::size_t end = 0;
  for (std::size_t i = 0; i < count; ++i) {
    end = content.find('\n', end) + 1;
  }
  write_file_atomically(path, std::string_view(content).substr(0, end));
}

}  // namespace loopmark

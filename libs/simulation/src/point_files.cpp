// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_files.hpp"

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "loopmark/core/error.hpp"

namespace loopmark::simulation {
namespace {

static_assert(std::endian::native == std::endian::little, "point files are little-endian");

template <class T>
void put(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace

std::string kitti_bytes(const PointCloud& cloud) {
  std::string bytes;
  bytes.reserve(16 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    put(bytes, cloud.points[i].x());
    put(bytes, cloud.points[i].y());
    put(bytes, cloud.points[i].z());
    put(bytes, cloud.intensity[i]);
  }
  return bytes;
}

std::string pcd_bytes(const PointCloud& cloud) {
  const std::string count = std::to_string(cloud.size());
  std::string bytes =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity ring t\nSIZE 4 4 4 4 2 4\n"
      "TYPE F F F F U F\nCOUNT 1 1 1 1 1 1\nWIDTH " +
      count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  bytes.reserve(bytes.size() + 22 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    put(bytes, cloud.points[i].x());
    put(bytes, cloud.points[i].y());
    put(bytes, cloud.points[i].z());
    put(bytes, cloud.intensity[i]);
    put(bytes, cloud.ring[i]);
    put(bytes, cloud.time_offset_s[i]);
  }
  return bytes;
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) {
    throw InputError(path.string(), "", std::string("cannot write: ") + std::strerror(errno != 0 ? errno : EIO),
                     "check the disk's space and the folder's rights");
  }
}

}  // namespace loopmark::simulation

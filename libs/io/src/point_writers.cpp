// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <stdexcept>
#include <string>

#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::io {
namespace {

static_assert(std::endian::native == std::endian::little, "point files are little-endian");

/// Collects the bytes of points.
class Bytes {
 public:
  explicit Bytes(std::size_t expected) { text_.reserve(expected); }
  template <class T>
  void add(const T& value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add_point(const Eigen::Vector3f& point) { text_.append(reinterpret_cast<const char*>(point.data()), 12); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// The channels of one point after x y z.
void add_channels(Bytes& bytes, const PointCloud& cloud, std::size_t i) {
  if (!cloud.intensity.empty()) {
    bytes.add(cloud.intensity[i]);
  }
  if (!cloud.ring.empty()) {
    bytes.add(cloud.ring[i]);
  }
  if (!cloud.time_offset_s.empty()) {
    bytes.add(cloud.time_offset_s[i]);
  }
}

std::string pcd_header(const PointCloud& cloud) {
  std::string fields = "FIELDS x y z";
  std::string size = "SIZE 4 4 4";
  std::string type = "TYPE F F F";
  std::string count = "COUNT 1 1 1";
  const auto add = [&](bool there, const char* name, const char* bytes, const char* kind) {
    if (there) {
      fields += std::string(" ") + name;
      size += std::string(" ") + bytes;
      type += std::string(" ") + kind;
      count += " 1";
    }
  };
  add(!cloud.intensity.empty(), "intensity", "4", "F");
  add(!cloud.ring.empty(), "ring", "2", "U");
  add(!cloud.time_offset_s.empty(), "t", "4", "F");
  const std::string points = std::to_string(cloud.size());
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "\n" + size + "\n" + type + "\n" +
         count + "\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n";
}

/// For `count` points with the channels of `cloud`.
std::string ply_header(std::size_t count, const PointCloud& cloud, bool coloured) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  header += "property float x\nproperty float y\nproperty float z\n";
  header += cloud.intensity.empty() ? "" : "property float intensity\n";
  header += cloud.ring.empty() ? "" : "property ushort ring\n";
  header += cloud.time_offset_s.empty() ? "" : "property float t\n";
  header += coloured ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "";
  return header + "end_header\n";
}

Bytes ply_bytes(const PointCloud& cloud, const std::vector<Rgb>& colours) {
  Bytes bytes(cloud.size() * 24);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    bytes.add_point(cloud.points[i]);
    add_channels(bytes, cloud, i);
    if (!colours.empty()) {
      bytes.add(colours[i]);
    }
  }
  return bytes;
}

void write(const std::filesystem::path& path, const std::string& header, const Bytes& bytes) {
  storage::write_file_atomically(path, [&](std::ostream& stream) { stream << header << bytes.text(); });
}

}  // namespace

void write_bin(const std::filesystem::path& path, const PointCloud& cloud) {
  Bytes bytes(cloud.size() * 16);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    bytes.add_point(cloud.points[i]);
    bytes.add(cloud.intensity.empty() ? 0.0F : cloud.intensity[i]);
  }
  write(path, "", bytes);
}

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud) {
  Bytes bytes(cloud.size() * 24);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    bytes.add_point(cloud.points[i]);
    add_channels(bytes, cloud, i);
  }
  write(path, pcd_header(cloud), bytes);
}

void write_ply(const std::filesystem::path& path, const PointCloud& cloud, const std::vector<Rgb>& colours) {
  write_ply_in_parts(path, cloud.size(), [&](const PlyPart& add) { add(cloud, colours); });
}

void write_ply_in_parts(const std::filesystem::path& path, std::size_t count,
                        const std::function<void(const PlyPart&)>& fill) {
  storage::write_file_atomically(path, [&](std::ostream& stream) {
    std::size_t written = 0;
    bool begun = false;
    const auto add = [&](const PointCloud& cloud, const std::vector<Rgb>& colours) {
      if (!begun) {
        stream << ply_header(count, cloud, !colours.empty());
        begun = true;
      }
      written += cloud.size();
      stream << ply_bytes(cloud, colours).text();
    };
    fill(add);
    if (!begun) {
      stream << ply_header(0, {}, false);
    }
    if (written != count) {
      throw std::logic_error("write_ply_in_parts: " + std::to_string(written) + " points instead of " +
                             std::to_string(count));
    }
  });
}

}  // namespace loopmark::io

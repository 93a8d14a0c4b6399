// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Files with one point cloud each: KITTI .bin, PCD, PLY.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/io/drive_log.hpp"

namespace loopmark::io {

/// A cloud as its file has it, without the points that make no sense.
struct PointFile {
  PointCloud cloud;                    ///< time_offset_s: as in the file, or since first_time_s
  std::optional<double> first_time_s;  ///< where the file has absolute times: the earliest, seconds
  DroppedPoints dropped;
  bool has_viewpoint = false;  ///< a PCD's VIEWPOINT that is no identity: it is not applied to the points
};

/// Reads a .bin, .pcd.bin, .pcd (ascii, binary, binary_compressed) or .ply (ascii, binary little endian) file.
/// Field names known: x y z, intensity (i, reflectivity), ring (laser_id, channel, line), t (time, timestamp,
/// time_stamp, offset_time) in seconds, ms, us or ns, relative or since 1970 (told apart by their size).
/// A ring channel with a value that is no number from 0 to 65535 is left out.
/// Throws DamagedScan naming the file, the byte or line and the problem; a file above 1 GiB is none of a scan.
PointFile read_point_file(const std::filesystem::path& path, const LogOptions& options = {});

/// Writes float32 x y z intensity (0 where the cloud has none), the layout of KITTI's velodyne folders.
void write_bin(const std::filesystem::path& path, const PointCloud& cloud);

/// Writes a binary PCD 0.7 with the channels that the cloud has: x y z [intensity] [ring U2] [t F4].
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud);

using Rgb = std::array<std::uint8_t, 3>;

/// Writes a binary little-endian PLY with the channels that the cloud has; `colours` is empty or as long.
void write_ply(const std::filesystem::path& path, const PointCloud& cloud, const std::vector<Rgb>& colours = {});

/// Takes a part of a cloud with its colours.
using PlyPart = std::function<void(const PointCloud&, const std::vector<Rgb>&)>;

/// The same for `count` points that never are in memory together: `fill` hands over one part after the other, all with
/// the channels of the first, and colours or none like it.
void write_ply_in_parts(const std::filesystem::path& path, std::size_t count,
                        const std::function<void(const PlyPart& add)>& fill);

}  // namespace loopmark::io

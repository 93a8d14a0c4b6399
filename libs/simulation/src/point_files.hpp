// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::simulation {

/// x y z intensity as little-endian float32, as KITTI's velodyne files.
std::string kitti_bytes(const PointCloud& cloud);

/// Binary PCD 0.7 with x y z intensity (float32), ring (uint16) and t (float32, seconds relative to the stamp).
std::string pcd_bytes(const PointCloud& cloud);

/// Writes bytes to a file without flushing it to the disk. Throws InputError when it cannot.
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

}  // namespace loopmark::simulation

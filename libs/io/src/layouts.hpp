// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The layouts of logs on disk. Each opener returns nullptr when what it needs is not there.
#pragma once

#include <filesystem>
#include <memory>

#include "loopmark/io/drive_log.hpp"

namespace loopmark::io::internal {

using LogPointer = std::unique_ptr<DriveLog>;

/// KITTI raw: velodyne_points/{data, timestamps.txt}, with poses from oxts/data and ../calib_imu_to_velo.txt. Not
/// motion-compensated; sweeps clockwise from the rear.
LogPointer open_kitti_raw(const std::filesystem::path& path, const LogOptions& options);

/// MulRan: Ouster/<nanoseconds>.bin and global_pose.csv.
LogPointer open_mulran(const std::filesystem::path& path, const LogOptions& options);

/// Apollo-SouthBay: pcds/<number>.pcd and poses/gt_poses.txt.
LogPointer open_apollo(const std::filesystem::path& path, const LogOptions& options);

/// KITTI odometry (velodyne/*.bin, times.txt, calib.txt, poses.txt) and any folder of point files.
LogPointer open_folder(const std::filesystem::path& path, const LogOptions& options);

/// An MRPT .rawlog, or a folder with one.
LogPointer open_rawlog(const std::filesystem::path& path, const LogOptions& options);

}  // namespace loopmark::io::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Trajectory files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::io {

/// Poses with their stamps; stamps_s is empty where the file has none.
struct Trajectory {
  std::vector<double> stamps_s;
  std::vector<Pose> poses;
};

/// One line a pose: stamp x y z qx qy qz qw (the TUM format). Stamps with 6 decimals.
std::string tum_text(const std::vector<double>& stamps_s, const std::vector<Pose>& poses);
void write_tum(const std::filesystem::path& path, const std::vector<double>& stamps_s, const std::vector<Pose>& poses);

/// One line a pose: the upper 3x4 of its matrix, row-major (KITTI's format).
std::string kitti_text(const std::vector<Pose>& poses);
void write_kitti(const std::filesystem::path& path, const std::vector<Pose>& poses);

/// Reads either format, told apart by the number of columns (8 or 12). Lines that are empty or start with # are
/// skipped. Throws InputError with the line that is wrong.
Trajectory read_trajectory(const std::filesystem::path& path);

/// The pose of every scan. Poses with times (TUM) are joined by time, in whatever order and at whatever rate they
/// stand: the one of the scan's time, or between two neighbours not more than 0.5 s apart. Poses without times (KITTI)
/// must be as many as the scans. Throws InputError naming `source` where there is no pose, or none for some of the
/// scans.
std::vector<Pose> poses_of_scans(const Trajectory& trajectory, const std::vector<double>& stamps_s,
                                 const std::string& source);

/// Sets of poses with different stamps: the pose at `stamp_s`, interpolated between its neighbours. Outside
/// the range the nearest end holds. `trajectory` is not empty and its stamps rise.
Pose pose_at(const Trajectory& trajectory, double stamp_s);

}  // namespace loopmark::io

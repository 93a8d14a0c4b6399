// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "folder_log_writer.hpp"

#include <cstdio>

#include "loopmark/core/number_text.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::io::internal {
namespace fs = std::filesystem;

FolderLogWriter::FolderLogWriter(const fs::path& folder, bool pcd)
    : folder_(folder.has_filename() ? folder : folder.parent_path()),
      partial_(folder_.string() + ".partial"),
      pcd_(pcd) {
  if (fs::exists(folder_)) {
    throw InputError(folder_.string(), "", "is there already", "nothing is overwritten: name another folder");
  }
  fs::remove_all(partial_);
  std::error_code error;
  if (!fs::create_directories(partial_ / "velodyne", error)) {
    throw InputError(partial_.string(), "", "cannot be made: " + error.message());
  }
}

FolderLogWriter::~FolderLogWriter() {
  std::error_code error;
  if (!finished_) {
    fs::remove_all(partial_, error);
  }
}

void FolderLogWriter::add(const Scan& scan, const std::optional<Pose>& T_world_lidar) {
  char text[64];
  std::snprintf(text, sizeof text, "%06zu.%s", scans_++, pcd_ ? "pcd" : "bin");
  if (pcd_) {
    write_pcd(partial_ / "velodyne" / text, scan.cloud);
  } else {
    write_bin(partial_ / "velodyne" / text, scan.cloud);
  }
  times_ += format_text("%.9f\n", scan.stamp_s);
  if (T_world_lidar) {
    poses_.push_back(*T_world_lidar);
  }
}

void FolderLogWriter::finish() {
  storage::write_file_atomically(partial_ / "times.txt", times_);
  if (!poses_.empty()) {
    write_kitti(partial_ / "poses.txt", poses_);
  }
  fs::rename(partial_, folder_);
  finished_ = true;
}

}  // namespace loopmark::io::internal

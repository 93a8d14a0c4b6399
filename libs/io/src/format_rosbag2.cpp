// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_formats.hpp"
#include "recording_log.hpp"

namespace loopmark::io::internal {
namespace {

namespace fs = std::filesystem;

/// A folder with a ROS 2 bag's metadata.yaml or .db3 files, or a database.
bool is_rosbag2(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    return recordings::is_sqlite(path) || path.extension() == ".db3";
  }
  if (fs::exists(path / "metadata.yaml", error)) {
    return true;
  }
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".db3" || it->path().stem().extension() == ".db3") {
      return true;
    }
  }
  return false;
}

}  // namespace

DriveLogFormat format_rosbag2() {
  return {"rosbag2", "ROS 2 bag: a folder with metadata.yaml, or a .db3 file", 10,
          [](const fs::path& path, const LogOptions& options) -> LogPointer {
            return is_rosbag2(path) ? open_recording_log(recordings::open_rosbag2(path), path, options) : nullptr;
          }};
}

}  // namespace loopmark::io::internal

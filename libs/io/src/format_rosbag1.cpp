// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_formats.hpp"
#include "recording_log.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_rosbag1() {
  return {"rosbag1", "ROS 1 bag: a .bag file", 20, [](const std::filesystem::path& path, const LogOptions& options) {
            const auto file = only_recording(path, recordings::is_rosbag);
            return file.empty() ? nullptr : open_recording_log(recordings::open_rosbag(file), file, options);
          }};
}

}  // namespace loopmark::io::internal

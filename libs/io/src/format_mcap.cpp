// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_formats.hpp"
#include "recording_log.hpp"

namespace loopmark::io::internal {

DriveLogFormat format_mcap() {
  return {"mcap", "MCAP recording: a .mcap file", 20, [](const std::filesystem::path& path, const LogOptions& options) {
            const auto file = only_recording(path, recordings::is_mcap);
            return file.empty() ? nullptr : open_recording_log(recordings::open_mcap(file), file, options);
          }};
}

}  // namespace loopmark::io::internal

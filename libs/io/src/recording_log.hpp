// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The scans of one topic of a recording as a drive log.
#pragma once

#include <memory>

#include "layouts.hpp"
#include "loopmark/recordings/recording.hpp"

namespace loopmark::io::internal {

/// Walks over the recording once. Throws InputError where there is no topic with scans that can be read.
LogPointer open_recording_log(std::unique_ptr<recordings::Recording> recording, const std::filesystem::path& path,
                              const LogOptions& options);

/// The file itself, or the only file of a folder that `is_one` accepts; empty where there is none. Throws InputError
/// where there are several.
std::filesystem::path only_recording(const std::filesystem::path& path, bool (*is_one)(const std::filesystem::path&));

}  // namespace loopmark::io::internal

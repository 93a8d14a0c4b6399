// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The layouts of data sets below one root folder.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/io/dataset.hpp"

namespace loopmark::io {

/// What a layout knows of its drives before any is opened.
struct Dataset::Parts {
  std::string layout;
  std::string description;
  std::filesystem::path root;
  std::vector<SessionInfo> sessions;
  std::function<std::unique_ptr<DriveLog>(const SessionInfo&)> open;
};

/// Each returns nothing when the root does not look like its layout.
std::optional<Dataset::Parts> find_nuscenes(const std::filesystem::path& root, const DatasetOptions& options);
std::optional<Dataset::Parts> find_kitti_odometry(const std::filesystem::path& root, const DatasetOptions& options);
std::optional<Dataset::Parts> find_kitti_raw(const std::filesystem::path& root, const DatasetOptions& options);
std::optional<Dataset::Parts> find_apollo_southbay(const std::filesystem::path& root, const DatasetOptions& options);
std::optional<Dataset::Parts> find_mulran(const std::filesystem::path& root, const DatasetOptions& options);
std::optional<Dataset::Parts> find_logs(const std::filesystem::path& root, const DatasetOptions& options);

/// The drives that a sessions file names. Throws InputError with the line that is wrong.
Dataset::Parts logs_of_sessions_file(const std::filesystem::path& root, const std::filesystem::path& file,
                                     const DatasetOptions& options);

}  // namespace loopmark::io

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/pair_sets/candidate_pool.hpp"

namespace loopmark::workflows {

/// The drives that a set is chosen from.
struct DriveList {
  std::vector<pair_sets::Drive> drives;
  std::filesystem::path root;   ///< what loopmark evaluate --data is to be given
  bool needs_sessions = false;  ///< the root is a folder of logs: sessions.txt must name them
};

/// Opens logs, or a data set with all of its drives. `poses`: reference poses of a single log that has none, one a
/// scan (TUM or KITTI format). Throws InputError for drives without poses.
DriveList open_drives(const std::vector<std::filesystem::path>& logs, const std::filesystem::path& poses);

/// Session numbers of a list such as "0-4,7".
std::vector<int> parse_sessions(const std::string& text);

}  // namespace loopmark::workflows

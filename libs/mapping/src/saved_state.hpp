// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What an interrupted run goes on from: the state of the odometry, which names the records that it stands behind.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/odometry/odometry.hpp"

namespace loopmark::mapping::internal {

struct SavedState {
  std::size_t known = 0;       ///< scan records that it goes on behind
  std::string records_sha256;  ///< of these, in order
  std::string pending;         ///< a keyframe that waits for the next scan, as bytes; or nothing
  std::string odometry;
};

/// Writes records/odometry.state and makes it last a power cut; the one before stays as odometry.state.before. The
/// records that it names must be on the disk already.
void write_state(const map_store::RunFolder& folder, const SavedState& state);

/// The states of a run, the newest first; those that cannot be read are left out.
std::vector<SavedState> read_states(const map_store::RunFolder& folder);

/// Whether a state was ever written here.
bool has_state(const map_store::RunFolder& folder);

/// Running SHA-256 of the first `count` payloads of a record file.
std::string sha256_of_records(const std::vector<std::string>& lines, std::size_t count);

}  // namespace loopmark::mapping::internal

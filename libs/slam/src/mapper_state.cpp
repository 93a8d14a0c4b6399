// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How an interrupted run goes on.
#include <algorithm>
#include <sstream>

#include "held_keyframe.hpp"
#include "keyframe_files.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/slam/mapper.hpp"

namespace loopmark {
namespace {

std::filesystem::path state_file(const RunFolder& folder) { return folder / "records/odometry.state"; }

/// What the state file holds: "KNOWN HELD\n", HELD bytes of a keyframe that waits, the state of the odometry.
struct SavedState {
  std::size_t known = 0;  ///< scan records that it goes on behind
  std::string held;
  std::string odometry;
};

SavedState read_state(const std::string& bytes) {
  SavedState state;
  const std::size_t line_end = bytes.find('\n');
  std::istringstream header(bytes.substr(0, line_end));
  std::size_t held = 0;
  header >> state.known >> held;
  state.held = bytes.substr(line_end + 1, held);
  state.odometry = bytes.substr(std::min(line_end + 1 + held, bytes.size()));
  return state;
}

template <class Record>
std::vector<Record> read_all(const std::filesystem::path& path, Record (*parse)(const std::string&)) {
  std::vector<Record> records;
  for (const std::string& line : read_records(path).lines) {
    records.push_back(parse(line));
  }
  return records;
}

}  // namespace

void Mapper::load() {
  scans_ = read_all(folder_.scan_records(), scan_from_line);
  SavedState saved;
  if (std::filesystem::exists(state_file(folder_))) {
    saved = read_state(read_file(state_file(folder_)));
    odometry_.set_state(saved.odometry);
  }
  // Records behind the saved state are made again: the same bytes, as the odometry is the same.
  scans_.resize(std::min(scans_.size(), saved.known));
  keep_records(folder_.scan_records(), scans_.size());
  if (!saved.held.empty()) {
    HeldKeyframe held = held_from_bytes(saved.held);
    scans_.push_back(std::move(held.record));
    held_ = std::move(held.scan);
  }
  for (const ScanRecord& scan : scans_) {
    piece_ = std::max(piece_, scan.piece);
    bad_scans_ += scan.state == ScanState::kDamaged ? 1 : 0;
  }
  for (const ScanRecord& scan : scans_) {
    path_.add(scan, keyframes_);
  }
  loops_ = read_all(folder_.loop_records(), loop_from_line);
}

void Mapper::checkpoint() const {
  const std::string held = held_ ? to_bytes(HeldKeyframe{scans_.back(), *held_}) : "";
  const std::size_t known = scans_.size() - (held_ ? 1 : 0);
  write_file_atomically(state_file(folder_),
                        std::to_string(known) + " " + std::to_string(held.size()) + "\n" + held + odometry_.state());
}

}  // namespace loopmark

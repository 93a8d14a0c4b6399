// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How an interrupted run goes on.
#include <algorithm>
#include <sstream>

#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/mapping/mapper.hpp"
#include "loopmark/storage/files.hpp"
#include "pending_keyframe.hpp"

namespace loopmark::mapping {
namespace {

std::filesystem::path state_file(const map_store::RunFolder& folder) { return folder / "records/odometry.state"; }

/// What the state file holds: "KNOWN HELD\n", HELD bytes of a keyframe that waits, the state of the odometry.
struct SavedState {
  std::size_t known = 0;  ///< scan records that it goes on behind
  std::string pending;
  std::string odometry;
};

SavedState read_state(const std::string& bytes) {
  SavedState state;
  const std::size_t line_end = bytes.find('\n');
  std::istringstream header(bytes.substr(0, line_end));
  std::size_t pending = 0;
  header >> state.known >> pending;
  state.pending = bytes.substr(line_end + 1, pending);
  state.odometry = bytes.substr(std::min(line_end + 1 + pending, bytes.size()));
  return state;
}

template <class Record>
std::vector<Record> read_all(const std::filesystem::path& path, Record (*parse)(const std::string&)) {
  std::vector<Record> records;
  for (const std::string& line : storage::read_records(path).lines) {
    records.push_back(parse(line));
  }
  return records;
}

}  // namespace

void Mapper::load() {
  scans_ = read_all(folder_.scan_records(), map_store::scan_from_line);
  SavedState saved;
  if (std::filesystem::exists(state_file(folder_))) {
    saved = read_state(storage::read_file(state_file(folder_)));
    odometry_.set_state(saved.odometry);
  }
  // Records behind the saved state are made again: the same bytes, as the odometry is the same.
  scans_.resize(std::min(scans_.size(), saved.known));
  map_store::keep_records(folder_.scan_records(), scans_.size());
  if (!saved.pending.empty()) {
    internal::PendingKeyframe pending = internal::pending_from_bytes(saved.pending);
    scans_.push_back(std::move(pending.record));
    pending_ = std::move(pending.scan);
  }
  for (const map_store::ScanRecord& scan : scans_) {
    segment_ = std::max(segment_, scan.segment);
    bad_scans_ += scan.state == map_store::ScanState::kDamaged ? 1 : 0;
  }
  for (const map_store::ScanRecord& scan : scans_) {
    path_.add(scan, keyframes_);
  }
  loops_ = read_all(folder_.loop_records(), map_store::loop_from_line);
}

void Mapper::checkpoint() const {
  const std::string pending = pending_ ? internal::to_bytes(internal::PendingKeyframe{scans_.back(), *pending_}) : "";
  const std::size_t known = scans_.size() - (pending_ ? 1 : 0);
  storage::write_file_atomically(state_file(folder_), std::to_string(known) + " " + std::to_string(pending.size()) +
                                                          "\n" + pending + odometry_.state());
}

}  // namespace loopmark::mapping

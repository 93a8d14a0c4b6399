// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How an interrupted run goes on. What lasts a kill or a power cut was written in this order: keyframes, the records
// that name them, the state that counts the records. So a state is good when its records are there, and the one before
// it, or the beginning, is good otherwise: what comes behind is computed again, to the same bytes.
#include <algorithm>
#include <array>

#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/map_store/record_rules.hpp"
#include "loopmark/mapping/mapper.hpp"
#include "loopmark/storage/files.hpp"
#include "pending_keyframe.hpp"
#include "saved_state.hpp"

namespace loopmark::mapping {
namespace fs = std::filesystem;
namespace {

/// What a mapper goes on from; by itself: nothing yet.
struct Beginning {
  std::vector<map_store::ScanRecord> scans;
  std::size_t known = 0;  ///< of the scans, those with a record
  std::optional<internal::PendingKeyframe> pending;
};

/// Throws InputError when a file of a keyframe is not there or empty.
void require_keyframes(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                       bool prepared) {
  constexpr std::array kEndings = {"pcd", "place", "prepared"};
  for (const map_store::ScanRecord& scan : scans) {
    for (std::size_t i = 0; scan.keyframe && i < kEndings.size() - (prepared ? 0 : 1); ++i) {
      const fs::path file = folder.keyframe(*scan.keyframe, kEndings[i]);
      std::error_code error;
      if (const auto size = fs::file_size(file, error); error || size == 0) {
        throw InputError(file.string(), "", "is missing or empty");
      }
    }
  }
}

/// Throws InputError when the run does not hold what the state counts.
Beginning beginning(const map_store::RunFolder& folder, const internal::SavedState& state,
                    const std::vector<std::string>& lines, bool prepared) {
  if (lines.size() < state.known || internal::sha256_of_records(lines, state.known) != state.records_sha256) {
    throw InputError(folder.scan_records().string(), "",
                     std::to_string(state.known) + " records were counted, and not all of them are there");
  }
  Beginning result;
  result.known = state.known;
  for (std::size_t i = 0; i < state.known; ++i) {
    result.scans.push_back(map_store::scan_from_line(lines[i]));
  }
  map_store::require_sound(result.scans, folder.scan_records());
  require_keyframes(folder, result.scans, prepared);
  if (!state.pending.empty()) {
    result.pending = internal::pending_from_bytes(state.pending);
    result.scans.push_back(result.pending->record);
    map_store::require_sound(result.scans, folder.scan_records());
  }
  return result;
}

/// The loops that are kept of those in the file: the first ones that are sound and of these keyframes.
std::vector<map_store::LoopRecord> sound_loops(const map_store::RunFolder& folder, std::size_t keyframes) {
  std::vector<map_store::LoopRecord> loops;
  for (const std::string& line : storage::read_records(folder.loop_records()).lines) {
    loops.push_back(map_store::loop_from_line(line));
  }
  map_store::require_sound(loops, keyframes, folder.loop_records());
  return loops;
}

}  // namespace

void Mapper::load() {
  const std::vector<std::string> lines = storage::read_sound_records(folder_.scan_records()).lines;
  const std::vector<internal::SavedState> states = internal::read_states(folder_);
  Beginning from;
  std::string problem = internal::has_state(folder_) && states.empty() ? "no saved state can be read" : "";
  bool newest = false;
  for (std::size_t i = 0; i < states.size() && from.scans.empty(); ++i) {
    try {
      odometry::Odometry odometry = odometry_;
      odometry.set_state(states[i].odometry);
      from = beginning(folder_, states[i], lines, registrar_ != nullptr);
      odometry_ = std::move(odometry);
      newest = i == 0;
    } catch (const InputError& error) {
      from = {};
      problem += (problem.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  if (!problem.empty()) {
    log(Severity::kWarning, folder_.path().string() + ": not all that was done is there any more (" + problem +
                                "): going on from scan " + std::to_string(from.scans.size()));
  }
  begin_with(std::move(from.scans), from.known, newest);
  if (from.pending) {
    pending_ = std::move(from.pending->scan);
  }
}

void Mapper::begin_with(std::vector<map_store::ScanRecord> scans, std::size_t known, bool newest) {
  map_store::keep_records(folder_.scan_records(), known);
  scans_ = std::move(scans);
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    segment_ = std::max(segment_, scans_[i].segment);
    bad_scans_ += scans_[i].state == map_store::ScanState::kDamaged ? 1 : 0;
    path_.add(scans_[i], keyframes_);
    if (i < known) {
      count_record(to_line(scans_[i]));
    }
  }
  if (newest) {
    loops_ = sound_loops(folder_, keyframes_.size());
  } else {  // loops of scans that are not known yet; they are found again
    loop_file_.reset();
    map_store::keep_records(folder_.loop_records(), 0);
    loop_file_ = std::make_unique<storage::RecordWriter>(folder_.loop_records());
  }
}

void Mapper::count_record(const std::string& line) {
  records_sum_.add(line);
  records_sum_.add("\n");
}

void Mapper::checkpoint() const {
  storage::sync_folder(folder_.keyframe(0, "pcd").parent_path());
  scan_file_->sync();
  loop_file_->sync();
  internal::SavedState state;
  state.known = scans_.size() - (pending_ ? 1 : 0);
  storage::Sha256 sum = records_sum_;
  state.records_sha256 = sum.hex();
  state.pending = pending_ ? internal::to_bytes(internal::PendingKeyframe{scans_.back(), *pending_}) : "";
  state.odometry = odometry_.state();
  internal::write_state(folder_, state);
}

}  // namespace loopmark::mapping

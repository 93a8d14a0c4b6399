// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The drives of a run: one where a log was mapped, several where runs were merged. What a run remembers of them can be
/// put together and taken apart.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/map_store/records.hpp"
#include "loopmark/map_store/run_folder.hpp"

namespace loopmark::multi_session {

/// One drive of a run: its scans follow each other in the run's records.
struct SessionRecord {
  std::string name;            ///< unique in the run; no blanks
  std::string identity;        ///< SHA-256 of its scan records as its log was mapped
  std::string log;             ///< path of its log when it was mapped
  std::size_t first_scan = 0;  ///< in the run
  std::size_t scans = 0;
};

/// The drives that a whole run holds, whose scans are given. Throws InputError when a record is damaged or does not fit
/// the scans.
std::vector<SessionRecord> read_sessions(const map_store::RunFolder& run,
                                         const std::vector<map_store::ScanRecord>& scans);

/// records/sessions.rec of a run that is being made.
void write_sessions(const map_store::RunFolder& run, const std::vector<SessionRecord>& drives);

/// The records of several drives, numbered as those of one run are: scans by their place, keyframes and segments in
/// order.
struct SessionSet {
  std::vector<SessionRecord> drives;
  std::vector<map_store::ScanRecord> scans;
  std::vector<map_store::LoopRecord> loops;
  std::vector<map_store::LoopDecision> decisions;
  /// For each keyframe its files, without their endings.
  std::vector<std::filesystem::path> keyframe_files;

  /// The drive of each keyframe.
  std::vector<std::size_t> session_of_keyframe() const;
};

/// What a whole run holds. Throws InputError when a record is damaged.
SessionSet read_session_set(const map_store::RunFolder& run);

/// Puts the drives of `more` behind those of `set`; a name that is taken gets a number. Throws InputError when a drive
/// is in both.
void append(SessionSet more, SessionSet& set);

/// The drives with `keep`, numbered anew; loops and decisions to others are left out.
SessionSet selected(const SessionSet& set, const std::vector<bool>& keep);

/// Gives the run that is being made the keyframes' files of the set, and none else: hard links, which nobody ever
/// writes into, or copies where the file system has none. Throws InputError when a file is missing.
void link_keyframes(const SessionSet& set, const map_store::RunFolder& run);

/// The records of the set, and none else, in a run that is being made.
void write_records(const SessionSet& set, const map_store::RunFolder& run);

}  // namespace loopmark::multi_session

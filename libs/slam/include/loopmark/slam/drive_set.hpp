// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The drives of a run: one where a log was mapped, several where runs were merged. What a run remembers of them can be
/// put together and taken apart.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/slam/loop_decisions.hpp"
#include "loopmark/slam/records.hpp"
#include "loopmark/slam/run_folder.hpp"

namespace loopmark {

/// One drive of a run: its scans follow each other in the run's records.
struct DriveRecord {
  std::string name;            ///< unique in the run; no blanks
  std::string identity;        ///< SHA-256 of its scan records as its log was mapped
  std::string log;             ///< path of its log when it was mapped
  std::size_t first_scan = 0;  ///< in the run
  std::size_t scans = 0;
};

/// The drives that a whole run holds. Throws InputError when a record is damaged.
std::vector<DriveRecord> read_drives(const RunFolder& run);

/// records/drives.rec of a run that is being made.
void write_drives(const RunFolder& run, const std::vector<DriveRecord>& drives);

/// The records of several drives, numbered as those of one run are: scans by their place, keyframes and pieces in
/// order.
struct DriveSet {
  std::vector<DriveRecord> drives;
  std::vector<ScanRecord> scans;
  std::vector<LoopRecord> loops;
  std::vector<LoopDecision> decisions;
  /// For each keyframe its files, without their endings.
  std::vector<std::filesystem::path> keyframe_files;

  /// The drive of each keyframe.
  std::vector<std::size_t> drive_of_keyframe() const;
};

/// What a whole run holds. Throws InputError when a record is damaged.
DriveSet read_drive_set(const RunFolder& run);

/// Puts the drives of `more` behind those of `set`; a name that is taken gets a number. Throws InputError when a drive
/// is in both.
void append(DriveSet more, DriveSet& set);

/// The drives with `keep`, numbered anew; loops and decisions to others are left out.
DriveSet selected(const DriveSet& set, const std::vector<bool>& keep);

/// Gives the run that is being made the keyframes' files of the set, and none else: hard links, which nobody ever
/// writes into, or copies where the file system has none. Throws InputError when a file is missing.
void link_keyframes(const DriveSet& set, const RunFolder& run);

/// The records of the set, and none else, in a run that is being made.
void write_records(const DriveSet& set, const RunFolder& run);

}  // namespace loopmark

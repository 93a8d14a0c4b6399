// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Which files of a log a run has read, and what they held.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::workflows::internal {

/// What the manifest says of the input.
struct InputSummary {
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  std::string sha256;  ///< of records/inputs.sha256
};

/// Hashes of a log's files, kept as they are read, so that a run that is resumed has all of them.
class InputRecord {
 public:
  InputRecord(const map_store::RunFolder& folder, const io::DriveLog& log);

  /// The first `scans` scans were read before an interruption. Throws InputError naming a file that has changed since;
  /// hashes that were lost are made again.
  void verify(std::size_t scans);

  /// What is to be kept of the file of scan `index`; empty where it is that of the scan before, or cannot be read. Call
  /// it right after the scan was read, when the file is in memory. Thread-safe.
  std::string of_scan(std::size_t index) const;
  void keep(const std::string& line);
  /// Makes what is kept last a power cut.
  void sync() const { file_.sync(); }

  /// Writes records/inputs.sha256, which `sha256sum -c` understands in the folder of the log: the files beside the
  /// scans (times, poses, calibration), then the scans in order.
  InputSummary finish() const;

 private:
  void take(const std::string& line, std::size_t number);

  const map_store::RunFolder& folder_;
  const io::DriveLog& log_;
  std::map<std::size_t, std::string> kept_;  ///< "BYTES SHA256 NAME" of each scan; the last time that it was read
  storage::RecordWriter file_;
};

}  // namespace loopmark::workflows::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Append-only files of checksummed lines, which survive a kill at any moment.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace loopmark::storage {

/// What a record file holds.
struct RecordLines {
  std::vector<std::string> lines;  ///< the payloads, in the order of writing
  std::size_t whole_bytes = 0;     ///< length of the whole records
  bool torn = false;               ///< a half-written record follows
  bool damaged = false;            ///< a damaged record follows, and others behind it
};

/// The records before the first that is damaged, whatever comes behind it. No file: no records.
RecordLines read_sound_records(const std::filesystem::path& path);

/// Reads the records: lines "CRC32 PAYLOAD". A last line that is cut off or whose checksum is wrong is what a kill
/// leaves, and reported as torn; damage anywhere else throws InputError naming the line. No file: no records.
RecordLines read_records(const std::filesystem::path& path);

/// Appends records to a file; a torn tail is cut off first. One writer at a time: a second one is refused.
class RecordWriter {
 public:
  explicit RecordWriter(const std::filesystem::path& path);
  ~RecordWriter();
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Appends one payload (no line break in it) with a single write. Throws InputError when the disk refuses.
  void append(std::string_view payload);

  /// Makes what was appended last a power cut.
  void sync() const;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace loopmark::storage

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Recordings, written: message after message in the order of their times.
#pragma once

#include <memory>

#include "loopmark/recordings/recording.hpp"

namespace loopmark::recordings {

enum class ChunkCompression { kNone, kFast, kStrong };

/// Writes into a file of another name, which finish() renames: a recording is there whole or not at all.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  /// Makes a topic known; returns the number to write its messages with.
  virtual std::uint32_t add_channel(const Channel& channel) = 0;
  /// Throws InputError when the disk is full.
  virtual void write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) = 0;
  virtual void finish() = 0;
};

/// An MCAP file with its index; kFast is lz4, kStrong zstd.
std::unique_ptr<RecordingWriter> create_mcap(const std::filesystem::path& file,
                                             ChunkCompression compression = ChunkCompression::kStrong);

/// A ROS 1 bag of format 2.0 with its index; kFast is lz4, kStrong bz2. Channels need their definition and md5.
std::unique_ptr<RecordingWriter> create_rosbag(const std::filesystem::path& file,
                                               ChunkCompression compression = ChunkCompression::kFast);

/// A ROS 2 bag: a folder with one SQLite file and metadata.yaml.
std::unique_ptr<RecordingWriter> create_rosbag2(const std::filesystem::path& folder);

}  // namespace loopmark::recordings

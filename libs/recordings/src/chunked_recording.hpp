// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What MCAP and ROS 1 bags have in common: one file of records, some of them chunks of compressed records.
#pragma once

#include "block_cache.hpp"
#include "byte_source.hpp"
#include "decompress.hpp"
#include "loopmark/recordings/recording.hpp"

namespace loopmark::recordings::internal {

/// A chunk's compressed bytes and what they promise.
struct ChunkFacts {
  Compression compression = Compression::kNone;
  std::uint64_t begin = 0;  ///< of the compressed bytes in the file
  std::uint64_t size = 0;
  std::uint64_t promised = 0;  ///< bytes when decompressed
  std::uint32_t crc = 0;       ///< CRC-32 of the decompressed bytes; 0: none given
};

class ChunkedRecording : public Recording {
 public:
  explicit ChunkedRecording(const std::filesystem::path& file) : source_(file), files_{file} {}

  const std::vector<std::filesystem::path>& files() const override { return files_; }
  const std::vector<Channel>& channels() const override { return channels_; }
  const std::vector<std::string>& problems() const override { return problems_; }
  std::string read(const MessageRef& message) const override;

 protected:
  const ByteSource& source() const { return source_; }
  std::vector<Channel>& known_channels() { return channels_; }

  /// The facts of the chunk whose place MessageRef::block names; read again from the file, so that none are kept.
  virtual ChunkFacts chunk_at(std::uint64_t place) const = 0;

  /// The decompressed bytes of a chunk; damaged ones become a problem and what could be had.
  std::string open_chunk(const ChunkFacts& chunk);

  /// Notes a problem; beyond a few dozen only their number is kept.
  void add_problem(std::uint64_t place, const std::string& problem);
  void begin_walk();

 private:
  Decompressed decompressed(const ChunkFacts& chunk, bool cut_off_is_fine) const;

  ByteSource source_;
  std::vector<std::filesystem::path> files_;
  std::vector<Channel> channels_;
  std::vector<std::string> problems_;
  std::size_t more_problems_ = 0;
  mutable BlockCache cache_;
};

}  // namespace loopmark::recordings::internal

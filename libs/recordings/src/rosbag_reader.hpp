// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "chunked_recording.hpp"

namespace loopmark::recordings::internal {

class RosbagReader : public ChunkedRecording {
 public:
  explicit RosbagReader(const std::filesystem::path& file);
  std::string format() const override { return "rosbag1"; }
  void walk(const BytesWanted& wanted, const MessageVisitor& visit) override;

 private:
  /// A record: its header's fields, and where its data lies.
  struct Record {
    std::map<std::string, std::string, std::less<>> fields;
    std::uint64_t data = 0;
    std::uint32_t data_size = 0;
    std::uint64_t end = 0;

    int op() const;
  };
  /// Bytes of the file or of a chunk in memory.
  using At = std::function<std::string_view(std::uint64_t offset, std::size_t count)>;

  ChunkFacts chunk_at(std::uint64_t place) const override;
  static std::string record_at(const At& bytes, std::uint64_t at, std::uint64_t end, Record& record);
  static ChunkFacts chunk_facts(const Record& record, std::string& problem);
  /// Records from `at` to `end`, in the file (block 0) or in the chunk `block`.
  void walk_records(const At& bytes, std::uint64_t at, std::uint64_t end, std::uint64_t block);
  void take_chunk(const At& bytes, const Record& record, std::uint64_t place);
  void take_connection(const At& bytes, const Record& record, std::uint64_t place);
  void take_message(const At& bytes, const Record& record, std::uint64_t place, std::uint64_t block);

  std::map<std::uint32_t, std::size_t> numbers_;  ///< connection -> index into channels()
  const BytesWanted* wanted_ = nullptr;
  const MessageVisitor* visit_ = nullptr;
};

}  // namespace loopmark::recordings::internal

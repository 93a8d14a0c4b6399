// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "chunked_recording.hpp"

namespace loopmark::recordings::internal {

class McapReader : public ChunkedRecording {
 public:
  explicit McapReader(const std::filesystem::path& file);
  std::string format() const override { return "mcap"; }
  void walk(const BytesWanted& wanted, const MessageVisitor& visit) override;

 private:
  struct Schema {
    std::string name, encoding, text;
  };

  ChunkFacts chunk_at(std::uint64_t place) const override;
  static ChunkFacts chunk_facts(std::string_view head, std::uint64_t place, std::string& problem);
  void take_record(Window& window, std::uint8_t opcode, std::uint64_t begin, std::uint64_t length);
  void take_definition(std::uint8_t opcode, std::string_view content, std::uint64_t place);
  void take_chunk(Window& window, std::uint64_t begin, std::uint64_t length);
  void take_records_in_file(Window& window, std::uint64_t at, std::uint64_t end);
  void take_records_in_memory(std::string_view records, std::uint64_t block);
  void take_message_in_file(Window& window, std::uint64_t begin, std::uint64_t length);
  /// The message at the front of `head`; false, and a problem, where there is none.
  bool message_of(std::string_view head, std::uint64_t length, std::uint64_t place, MessageRef& message);

  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::size_t> numbers_;  ///< channel id -> index into channels()
  const BytesWanted* wanted_ = nullptr;           ///< of the walk in progress
  const MessageVisitor* visit_ = nullptr;
};

}  // namespace loopmark::recordings::internal

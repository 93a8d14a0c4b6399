// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// MCAP, version 0 of its specification: magic, records (opcode, length, content), magic. Its index is not used.
#include "mcap_reader.hpp"

#include <algorithm>

namespace loopmark::recordings {
namespace internal {
namespace {

constexpr std::uint64_t kRecordHead = 9;  // opcode, uint64 length
constexpr std::size_t kMostSchemas = 65535;
/// A compressed chunk can hold few bytes for many messages; of a chunk's own fields no more than this is read.
constexpr std::size_t kChunkHead = 8 + 8 + 8 + 4 + 4 + 64 + 8;
constexpr std::size_t kMessageHead = 2 + 4 + 8 + 8;

Encoding encoding_of(const std::string& name) {
  return name == "cdr" ? Encoding::kCdr : name == "ros1" ? Encoding::kRos1 : Encoding::kOther;
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file) : ChunkedRecording(file) {
  if (!is_mcap(file)) {
    throw InputError(file.string(), "byte 0", "this is no MCAP file: its first bytes are not MCAP's");
  }
}

ChunkFacts McapReader::chunk_at(std::uint64_t place) const {
  const std::uint64_t left = source().size() - std::min(source().size(), place);
  const std::string head = source().exactly(place, std::min<std::uint64_t>(kChunkHead, left));
  std::string problem;
  return chunk_facts(head, place, problem);
}

/// Fields of a chunk record: start and end time, uncompressed size, CRC, compression, then the records' bytes.
ChunkFacts McapReader::chunk_facts(std::string_view head, std::uint64_t place, std::string& problem) {
  Taker take{head};
  take.bytes(16);
  ChunkFacts facts;
  facts.promised = take.number<std::uint64_t>();
  facts.crc = take.number<std::uint32_t>();
  const std::string name(take.text());
  facts.size = take.number<std::uint64_t>();
  facts.begin = place + (head.size() - take.rest.size());
  if (!take.ok) {
    problem = "a chunk without its fields";
  } else if (name == "lz4") {
    facts.compression = Compression::kLz4;
  } else if (name == "zstd") {
    facts.compression = Compression::kZstd;
  } else if (!name.empty()) {
    problem = "a chunk compressed as '" + name + "', which is neither lz4 nor zstd";
  }
  return facts;
}

void McapReader::walk(const BytesWanted& wanted, const MessageVisitor& visit) {
  begin_walk();
  wanted_ = &wanted;
  visit_ = &visit;
  Window window(source());
  constexpr std::uint64_t kMagic = 8;
  bool ended = false;
  std::uint64_t at = kMagic;
  while (!ended) {
    const std::string_view head = window.at(at, kRecordHead);
    if (head.size() < kRecordHead) {
      add_problem(at,
                  "the file has no end record: it was cut off, or its recording was not ended; what is whole is used");
      break;
    }
    const auto opcode = static_cast<std::uint8_t>(head[0]);
    const auto length = number_at<std::uint64_t>(head, 1);
    const std::uint64_t begin = at + kRecordHead;
    const std::uint64_t left = source().size() - begin;
    ended = opcode == 0x0F || opcode == 0x02;  // data end, footer
    if (opcode == 0 || (length > left && opcode != 0x06)) {
      add_problem(at, opcode == 0 ? "no record begins here; the rest of the file is not read"
                                  : "a record of " + std::to_string(length) + " bytes where " + std::to_string(left) +
                                        " are left: the file was cut off; what is whole is used");
      break;
    }
    take_record(window, opcode, begin, length);
    if (length > left) {
      break;  // a chunk that was cut off; said there
    }
    at = begin + length;
  }
}

void McapReader::take_record(Window& window, std::uint8_t opcode, std::uint64_t begin, std::uint64_t length) {
  if (opcode == 0x06) {
    take_chunk(window, begin, length);
  } else if (opcode == 0x05) {
    take_message_in_file(window, begin, length);
  } else if (opcode == 0x03 || opcode == 0x04) {
    if (length > kMostBytes) {
      add_problem(begin, "a definition of " + std::to_string(length) + " bytes is passed over");
      return;
    }
    take_definition(opcode, window.at(begin, static_cast<std::size_t>(length)), begin);
  }
}

void McapReader::take_definition(std::uint8_t opcode, std::string_view content, std::uint64_t place) {
  Taker take{content};
  const auto id = take.number<std::uint16_t>();
  if (opcode == 0x03) {
    Schema schema{std::string(take.text()), std::string(take.text()), std::string(take.text())};
    if (take.ok && schemas_.size() < kMostSchemas) {
      schemas_[id] = std::move(schema);
    }
  } else {
    const auto schema = take.number<std::uint16_t>();
    Channel channel;
    channel.topic = take.text();
    channel.encoding_name = take.text();
    channel.encoding = encoding_of(channel.encoding_name);
    if (const auto known = schemas_.find(schema); known != schemas_.end()) {
      channel.type = plain_type(known->second.name);
      channel.definition = known->second.text;
    }
    if (take.ok && numbers_.try_emplace(id, known_channels().size()).second) {
      known_channels().push_back(std::move(channel));
    }
  }
  if (!take.ok) {
    add_problem(place, "a definition that ends within its fields is passed over");
  }
}

/// A chunk's records where they lie in the file when they are not compressed; else from memory.
void McapReader::take_chunk(Window& window, std::uint64_t begin, std::uint64_t length) {
  std::string problem;
  const auto head = static_cast<std::size_t>(std::min<std::uint64_t>(kChunkHead, length));
  const ChunkFacts facts = chunk_facts(window.at(begin, head), begin, problem);
  if (problem.empty() && (facts.begin - begin > length || facts.size > length - (facts.begin - begin))) {
    problem = "a chunk whose records are longer than itself";
  }
  if (!problem.empty()) {
    add_problem(begin, problem + "; it is passed over");
    return;
  }
  if (facts.compression != Compression::kNone) {
    const std::string bytes = open_chunk(facts);
    take_records_in_memory(bytes, begin);
    return;
  }
  const std::uint64_t end = std::min(facts.begin + facts.size, source().size());
  if (end < facts.begin + facts.size) {
    add_problem(begin, "the file ends within this chunk; its whole messages are used");
  }
  take_records_in_file(window, facts.begin, end);
}

void McapReader::take_records_in_file(Window& window, std::uint64_t at, std::uint64_t end) {
  while (at + kRecordHead <= end) {
    const std::string_view head = window.at(at, kRecordHead);
    if (head.size() < kRecordHead) {
      return;
    }
    const auto opcode = static_cast<std::uint8_t>(head[0]);
    const auto length = number_at<std::uint64_t>(head, 1);
    at += kRecordHead;
    if (length > end - at) {
      if (end < source().size()) {
        add_problem(at, "a record that is longer than its chunk; the rest of the chunk is not read");
      }
      return;
    }
    if (opcode != 0x06) {  // chunks do not nest
      take_record(window, opcode, at, length);
    }
    at += length;
  }
}

void McapReader::take_message_in_file(Window& window, std::uint64_t begin, std::uint64_t length) {
  const std::string_view head =
      window.at(begin, static_cast<std::size_t>(std::min<std::uint64_t>(kMessageHead, length)));
  MessageRef message;
  if (!message_of(head, length, begin, message)) {
    return;
  }
  message.offset = begin + kMessageHead;
  const std::size_t want = std::min<std::size_t>((*wanted_)(known_channels()[message.channel]), message.size);
  (*visit_)(message, want == 0 ? std::string_view{} : window.at(message.offset, want));
}

void McapReader::take_records_in_memory(std::string_view records, std::uint64_t block) {
  std::uint64_t at = 0;
  while (records.size() - at >= kRecordHead) {
    const auto opcode = static_cast<std::uint8_t>(records[at]);
    const auto length = number_at<std::uint64_t>(records, at + 1);
    at += kRecordHead;
    if (length > records.size() - at) {
      return;  // the end of a damaged chunk, said already; or the record's length is damaged
    }
    const std::string_view content = records.substr(at, length);
    if (opcode == 0x03 || opcode == 0x04) {
      take_definition(opcode, content, block);
    } else if (opcode == 0x05) {
      MessageRef message;
      if (message_of(content.substr(0, kMessageHead), length, block, message)) {
        message.block = block;
        message.offset = at + kMessageHead;
        (*visit_)(message, content.substr(kMessageHead, (*wanted_)(known_channels()[message.channel])));
      }
    }
    at += length;
  }
}

bool McapReader::message_of(std::string_view head, std::uint64_t length, std::uint64_t place, MessageRef& message) {
  Taker take{head};
  const auto number = numbers_.find(take.number<std::uint16_t>());
  take.number<std::uint32_t>();  // sequence
  message.time_ns = static_cast<std::int64_t>(take.number<std::uint64_t>());
  take.number<std::uint64_t>();  // publish time
  if (!take.ok || length - kMessageHead > kMostBytes) {
    add_problem(place, "a message that is too short or too long is passed over");
    return false;
  }
  if (number == numbers_.end()) {
    add_problem(place, "a message of a channel that was not made known is passed over");
    return false;
  }
  message.channel = static_cast<std::uint32_t>(number->second);
  message.size = static_cast<std::uint32_t>(length - kMessageHead);
  return true;
}

}  // namespace internal

bool is_mcap(const std::filesystem::path& file) {
  return internal::first_bytes(file, 8) == std::string_view("\x89MCAP0\r\n", 8);
}

std::unique_ptr<Recording> open_mcap(const std::filesystem::path& file) {
  return std::make_unique<internal::McapReader>(file);
}

std::string plain_type(std::string_view type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string_view::npos ? std::string(type)
                                      : std::string(type.substr(0, at)) + std::string(type.substr(at + 4));
}

}  // namespace loopmark::recordings

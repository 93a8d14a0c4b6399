// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// ROS 1 bags, format 2.0: a line of magic, then records of a header (named fields) and data. The index is not used.
#include "rosbag_reader.hpp"

#include <algorithm>

namespace loopmark::recordings {
namespace internal {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kPlain = 1;  // as a block: within a chunk that is not compressed; no chunk begins at byte 1
constexpr std::size_t kMostHeader = std::size_t{1} << 20U;  // bytes; headers of records have a few dozen

template <class Fields, class T>
bool field(const Fields& fields, std::string_view name, T& value) {
  const auto found = fields.find(name);
  if (found == fields.end() || found->second.size() != sizeof(T)) {
    return false;
  }
  value = number_at<T>(found->second);
  return true;
}

/// "name=value" parts, each with its length before it. False where they do not fit.
template <class Fields>
bool split_fields(std::string_view header, Fields& fields) {
  Taker take{header};
  while (take.ok && !take.rest.empty()) {
    const std::string_view part = take.text();
    const std::size_t equals = part.find('=');
    if (!take.ok || equals == std::string_view::npos) {
      return false;
    }
    fields[std::string(part.substr(0, equals))] = part.substr(equals + 1);
  }
  return take.ok;
}

}  // namespace

int RosbagReader::Record::op() const {
  std::uint8_t value = 0;
  return field(fields, "op", value) ? value : -1;
}

RosbagReader::RosbagReader(const std::filesystem::path& file) : ChunkedRecording(file) {
  const std::string first = first_bytes(file, kMagic.size());
  if (first.substr(0, 9) == "#ROSBAG V" || first.substr(0, 8) == "#ROSRECO") {
    if (first != kMagic) {
      throw InputError(file.string(), "byte 0", "a bag of an old format, " + first.substr(1, first.find('\n') - 1),
                       "bring it to format 2.0 with: rosbag fix");
    }
    return;
  }
  throw InputError(file.string(), "byte 0", "this is no ROS 1 bag: it does not begin with #ROSBAG V2.0");
}

/// Reads a record's header; returns what is wrong with it, or nothing.
std::string RosbagReader::record_at(const At& bytes, std::uint64_t at, std::uint64_t end, Record& record) {
  const auto length_at = [&](std::uint64_t place, std::uint32_t& length) {
    const std::string_view four = place + 4 <= end ? bytes(place, 4) : std::string_view{};
    if (four.size() < 4) {
      return false;
    }
    length = number_at<std::uint32_t>(four);
    return true;
  };
  std::uint32_t header_size = 0;
  const std::string cut_off = "the file ends within a record: it was cut off; what is whole is used";
  if (!length_at(at, header_size) || header_size > end - at - 4) {
    return cut_off;
  }
  if (header_size > kMostHeader) {
    return "a record's header of " + std::to_string(header_size) +
           " bytes: the file is damaged here; the rest is not read";
  }
  record.fields.clear();
  if (!split_fields(bytes(at + 4, header_size), record.fields) || record.op() < 0) {
    return "no record begins here: the file is damaged; the rest is not read";
  }
  if (!length_at(at + 4 + header_size, record.data_size)) {
    return cut_off;
  }
  record.data = at + 8 + header_size;
  record.end = record.data + record.data_size;
  return "";
}

ChunkFacts RosbagReader::chunk_facts(const Record& record, std::string& problem) {
  ChunkFacts facts;
  facts.begin = record.data;
  facts.size = record.data_size;
  std::uint32_t promised = 0;
  const auto name = record.fields.find("compression");
  if (name == record.fields.end() || !field(record.fields, "size", promised)) {
    problem = "a chunk without compression or size";
  } else if (name->second == "bz2") {
    facts.compression = Compression::kBz2;
  } else if (name->second == "lz4") {
    facts.compression = Compression::kLz4;
  } else if (name->second != "none") {
    problem = "a chunk compressed as '" + name->second.substr(0, 40) + "', which is neither bz2 nor lz4";
  }
  facts.promised = promised;
  return facts;
}

ChunkFacts RosbagReader::chunk_at(std::uint64_t place) const {
  std::string kept;
  const At bytes = [&](std::uint64_t offset, std::size_t count) {
    kept = source().exactly(offset, count);
    return std::string_view(kept);
  };
  Record record;
  std::string problem = record_at(bytes, place, source().size(), record);
  return chunk_facts(record, problem);
}

void RosbagReader::walk(const BytesWanted& wanted, const MessageVisitor& visit) {
  begin_walk();
  wanted_ = &wanted;
  visit_ = &visit;
  Window window(source());
  walk_records([&](std::uint64_t offset, std::size_t count) { return window.at(offset, count); }, kMagic.size(),
               source().size(), 0);
}

void RosbagReader::walk_records(const At& bytes, std::uint64_t at, std::uint64_t end, std::uint64_t block) {
  Record record;
  while (at < end) {
    const std::string problem = record_at(bytes, at, end, record);
    if (!problem.empty()) {
      add_problem(block <= kPlain ? at : block, problem);
      return;
    }
    const std::uint64_t place = at;
    at = record.end;
    const int op = record.op();
    if (op == 0x05 && block == 0) {
      take_chunk(bytes, record, place);
      continue;
    }
    if (record.end > end) {
      add_problem(block <= kPlain ? place : block,
                  "the file ends within a record: it was cut off; what is whole is used");
      return;
    }
    if (op == 0x07) {
      take_connection(bytes, record, block <= kPlain ? place : block);
    } else if (op == 0x02) {
      take_message(bytes, record, place, block);
    } else if (op == 0x03 && record.fields.contains("encryptor") && !record.fields["encryptor"].empty()) {
      throw InputError(source().path().string(), "", "this bag is encrypted", "decrypt it with: rosbag decrypt");
    }
  }
}

void RosbagReader::take_chunk(const At& bytes, const Record& record, std::uint64_t place) {
  std::string problem;
  const ChunkFacts facts = chunk_facts(record, problem);
  if (!problem.empty()) {
    add_problem(place, problem + "; it is passed over");
    return;
  }
  if (facts.compression == Compression::kNone) {
    walk_records(bytes, facts.begin, std::min(facts.begin + facts.size, source().size()), kPlain);
    return;
  }
  const std::string content = open_chunk(facts);
  walk_records([&](std::uint64_t offset, std::size_t count) { return std::string_view(content).substr(offset, count); },
               0, content.size(), place);
}

/// A topic's name stands in the header; type and definition in the data, as fields again.
void RosbagReader::take_connection(const At& bytes, const Record& record, std::uint64_t place) {
  std::uint32_t id = 0;
  std::map<std::string, std::string, std::less<>> facts;
  const bool fits = record.data_size <= kMostBytes && split_fields(bytes(record.data, record.data_size), facts);
  if (!fits || !field(record.fields, "conn", id) || !record.fields.contains("topic")) {
    add_problem(place, "a connection that cannot be read is passed over");
    return;
  }
  if (numbers_.try_emplace(id, known_channels().size()).second) {
    known_channels().push_back({record.fields.find("topic")->second, facts["type"], Encoding::kRos1, "ros1",
                                facts["message_definition"], facts["md5sum"]});
  }
}

void RosbagReader::take_message(const At& bytes, const Record& record, std::uint64_t place, std::uint64_t block) {
  std::uint32_t id = 0;
  std::uint64_t time = 0;
  const bool fits = field(record.fields, "conn", id) && field(record.fields, "time", time);
  const auto number = numbers_.find(id);
  if (!fits || number == numbers_.end() || record.data_size > kMostBytes) {
    add_problem(block <= kPlain ? place : block,
                "a message without time, of an unknown connection or too long is passed over");
    return;
  }
  MessageRef message;
  message.channel = static_cast<std::uint32_t>(number->second);
  message.time_ns =
      static_cast<std::int64_t>(time & 0xFFFFFFFFU) * 1'000'000'000 + static_cast<std::int64_t>(time >> 32U);
  message.block = block == kPlain ? 0 : block;
  message.offset = record.data;
  message.size = record.data_size;
  const std::size_t want = std::min<std::size_t>((*wanted_)(known_channels()[message.channel]), message.size);
  (*visit_)(message, want == 0 ? std::string_view{} : bytes(message.offset, want));
}

}  // namespace internal

bool is_rosbag(const std::filesystem::path& file) {
  const std::string first = internal::first_bytes(file, 9);
  return first == "#ROSBAG V" || first.substr(0, 8) == "#ROSRECO";
}

std::unique_ptr<Recording> open_rosbag(const std::filesystem::path& file) {
  return std::make_unique<internal::RosbagReader>(file);
}

}  // namespace loopmark::recordings

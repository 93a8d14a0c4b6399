// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_writer.hpp"

#include <zlib.h>

#include <algorithm>

namespace loopmark::recordings {
namespace internal {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = std::size_t{4} << 20U;

std::string record(std::uint8_t opcode, std::string_view content) {
  std::string bytes(1, static_cast<char>(opcode));
  put(bytes, static_cast<std::uint64_t>(content.size()));
  return bytes.append(content);
}

/// "sensor_msgs/Imu" -> "sensor_msgs/msg/Imu".
std::string ros2_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  return slash == std::string::npos ? type : type.substr(0, slash) + "/msg" + type.substr(slash);
}

const char* name_of(Compression compression) {
  return compression == Compression::kZstd ? "zstd" : compression == Compression::kLz4 ? "lz4" : "";
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file, Compression compression)
    : file_(file), compression_(compression) {
  file_.append(kMagic);
  std::string header;
  put_text(header, "ros2");
  put_text(header, "loopmark");
  file_.append(record(0x01, header));
}

std::uint32_t McapWriter::add_channel(const Channel& channel) {
  const auto id = static_cast<std::uint16_t>(counts_.size());
  const bool ros1 = channel.encoding == Encoding::kRos1;
  std::string schema;
  put(schema, static_cast<std::uint16_t>(id + 1));
  put_text(schema, ros1 ? channel.type : ros2_type(channel.type));
  put_text(schema, ros1 ? "ros1msg" : "ros2msg");
  put_text(schema, channel.definition);
  std::string topic;
  put(topic, id);
  put(topic, static_cast<std::uint16_t>(id + 1));
  put_text(topic, channel.topic);
  put_text(topic, ros1 ? "ros1" : "cdr");
  put_text(topic, "");  // no metadata
  const std::string both = record(0x03, schema) + record(0x04, topic);
  definitions_ += both;
  chunk_ += both;
  counts_.push_back(0);
  return id;
}

void McapWriter::write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) {
  const auto time = static_cast<std::uint64_t>(time_ns);
  std::string& index = indexes_[channel];
  put(index, time);
  put(index, static_cast<std::uint64_t>(chunk_.size()));
  chunk_.push_back(0x05);
  put(chunk_, static_cast<std::uint64_t>(22 + message.size()));
  put(chunk_, static_cast<std::uint16_t>(channel));
  put(chunk_, static_cast<std::uint32_t>(counts_[channel]++));
  put(chunk_, time);
  put(chunk_, time);
  chunk_ += message;
  chunk_start_ = std::min(chunk_start_, time);
  chunk_end_ = std::max(chunk_end_, time);
  if (chunk_.size() >= kChunkBytes) {
    end_chunk();
  }
}

void McapWriter::end_chunk() {
  if (indexes_.empty() && chunk_.empty()) {
    return;
  }
  if (indexes_.empty()) {
    chunk_start_ = chunk_end_ = 0;
  }
  const std::string packed = compress(compression_, chunk_);
  std::string content;
  put(content, chunk_start_);
  put(content, chunk_end_);
  put(content, static_cast<std::uint64_t>(chunk_.size()));
  put(content, static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(chunk_.data()), chunk_.size())));
  put_text(content, name_of(compression_));
  put(content, static_cast<std::uint64_t>(packed.size()));
  content += packed;
  const std::uint64_t begin = file_.size();
  file_.append(record(0x06, content));
  const std::uint64_t length = file_.size() - begin;
  add_chunk_index(begin, length, packed.size());
  start_ = std::min(start_, chunk_start_);
  end_ = std::max(end_, chunk_end_);
  chunk_.clear();
  indexes_.clear();
  chunk_start_ = ~std::uint64_t{0};
  chunk_end_ = 0;
}

/// Writes the message indexes behind the chunk, and keeps its entry for the summary.
void McapWriter::add_chunk_index(std::uint64_t begin, std::uint64_t length, std::uint64_t packed) {
  const std::uint64_t indexes_begin = file_.size();
  std::string offsets;
  for (const auto& [channel, entries] : indexes_) {
    put(offsets, static_cast<std::uint16_t>(channel));
    put(offsets, file_.size());
    std::string content;
    put(content, static_cast<std::uint16_t>(channel));
    put_text(content, entries);
    file_.append(record(0x07, content));
  }
  std::string entry;
  put(entry, chunk_start_);
  put(entry, chunk_end_);
  put(entry, begin);
  put(entry, length);
  put_text(entry, offsets);
  put(entry, file_.size() - indexes_begin);
  put_text(entry, name_of(compression_));
  put(entry, packed);
  put(entry, static_cast<std::uint64_t>(chunk_.size()));
  chunk_indexes_ += record(0x08, entry);
  ++chunks_;
}

void McapWriter::finish() {
  end_chunk();
  std::string data_end;
  put(data_end, std::uint32_t{0});
  file_.append(record(0x0F, data_end));
  const std::uint64_t summary = file_.size();
  std::string statistics, counts;
  std::uint64_t messages = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    put(counts, static_cast<std::uint16_t>(i));
    put(counts, counts_[i]);
    messages += counts_[i];
  }
  put(statistics, messages);
  put(statistics, static_cast<std::uint16_t>(counts_.size()));
  put(statistics, static_cast<std::uint32_t>(counts_.size()));
  put(statistics, std::uint32_t{0});
  put(statistics, std::uint32_t{0});
  put(statistics, chunks_);
  put(statistics, messages > 0 ? start_ : 0);
  put(statistics, end_);
  put_text(statistics, counts);
  file_.append(definitions_ + record(0x0B, statistics) + chunk_indexes_);
  std::string footer;
  put(footer, summary);
  put(footer, std::uint64_t{0});  // no summary offsets
  put(footer, std::uint32_t{0});  // no checksum of the summary
  file_.append(record(0x02, footer));
  file_.append(kMagic);
  file_.finish();
}

}  // namespace internal

std::unique_ptr<RecordingWriter> create_mcap(const std::filesystem::path& file, ChunkCompression compression) {
  const auto kind = compression == ChunkCompression::kNone   ? internal::Compression::kNone
                    : compression == ChunkCompression::kFast ? internal::Compression::kLz4
                                                             : internal::Compression::kZstd;
  return std::make_unique<internal::McapWriter>(file, kind);
}

}  // namespace loopmark::recordings

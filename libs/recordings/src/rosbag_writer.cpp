// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag_writer.hpp"

#include <algorithm>

namespace loopmark::recordings {
namespace internal {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kChunkBytes = 768 * 1024;  // as rosbag record's
constexpr std::size_t kBagHeader = 4096;         // bytes of the first record, padded so that it can be written again

/// Header fields of a record, "name=value".
class Header {
 public:
  explicit Header(std::uint8_t op) { add("op", op); }
  template <class T>
  Header& add(const char* name, T value) {
    std::string bytes;
    put(bytes, value);
    return add_text(name, bytes);
  }
  Header& add_text(const char* name, std::string_view value) {
    put_text(text_, std::string(name) + "=" + std::string(value));
    return *this;
  }
  /// The record with this header and data.
  std::string record(std::string_view data) const {
    std::string bytes;
    put_text(bytes, text_);
    put_text(bytes, data);
    return bytes;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Seconds in the low half, nanoseconds in the high one, as the files have it.
std::uint64_t bag_time(std::int64_t time_ns) {
  const auto time = static_cast<std::uint64_t>(time_ns);
  return time / 1'000'000'000 | (time % 1'000'000'000) << 32U;
}

bool earlier(std::uint64_t a, std::uint64_t b) {
  const auto swapped = [](std::uint64_t t) { return t << 32U | t >> 32U; };
  return swapped(a) < swapped(b);
}

}  // namespace

RosbagWriter::RosbagWriter(const std::filesystem::path& file, Compression compression)
    : file_(file), compression_(compression) {
  file_.append(kMagic);
  file_.append(bag_header(0));
}

std::string RosbagWriter::bag_header(std::uint64_t index_begin) const {
  Header header(0x03);
  header.add("index_pos", index_begin)
      .add("conn_count", static_cast<std::uint32_t>(connections_.size()))
      .add("chunk_count", chunks_);
  return header.record(std::string(kBagHeader - 8 - header.text().size(), ' '));
}

std::uint32_t RosbagWriter::add_channel(const Channel& channel) {
  const auto id = static_cast<std::uint32_t>(connections_.size());
  std::string data;
  put_text(data, "topic=" + channel.topic);
  put_text(data, "type=" + channel.type);
  put_text(data, "md5sum=" + channel.md5);
  put_text(data, "message_definition=" + channel.definition);
  connections_.push_back(Header(0x07).add("conn", id).add_text("topic", channel.topic).record(data));
  chunk_ += connections_.back();
  return id;
}

void RosbagWriter::write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) {
  const std::uint64_t time = bag_time(time_ns);
  std::string& index = indexes_[channel];
  put(index, time);
  put(index, static_cast<std::uint32_t>(chunk_.size()));
  const bool first = indexes_.size() == 1 && index.size() == 12;
  chunk_start_ = first || earlier(time, chunk_start_) ? time : chunk_start_;
  chunk_end_ = first || earlier(chunk_end_, time) ? time : chunk_end_;
  chunk_ += Header(0x02).add("conn", channel).add("time", time).record(message);
  if (chunk_.size() >= kChunkBytes) {
    end_chunk();
  }
}

void RosbagWriter::end_chunk() {
  if (indexes_.empty()) {
    return;
  }
  const char* name = compression_ == Compression::kBz2 ? "bz2" : compression_ == Compression::kLz4 ? "lz4" : "none";
  const std::uint64_t begin = file_.size();
  file_.append(Header(0x05)
                   .add_text("compression", name)
                   .add("size", static_cast<std::uint32_t>(chunk_.size()))
                   .record(compress(compression_, chunk_)));
  std::string counts;
  for (const auto& [connection, entries] : indexes_) {
    const auto count = static_cast<std::uint32_t>(entries.size() / 12);
    put(counts, connection);
    put(counts, count);
    file_.append(Header(0x04).add("ver", std::uint32_t{1}).add("conn", connection).add("count", count).record(entries));
  }
  chunk_infos_ += Header(0x06)
                      .add("ver", std::uint32_t{1})
                      .add("chunk_pos", begin)
                      .add("start_time", chunk_start_)
                      .add("end_time", chunk_end_)
                      .add("count", static_cast<std::uint32_t>(indexes_.size()))
                      .record(counts);
  ++chunks_;
  chunk_.clear();
  indexes_.clear();
}

void RosbagWriter::finish() {
  end_chunk();
  const std::uint64_t index_begin = file_.size();
  for (const std::string& connection : connections_) {
    file_.append(connection);
  }
  file_.append(chunk_infos_);
  file_.replace(kMagic.size(), bag_header(index_begin));
  file_.finish();
}

}  // namespace internal

std::unique_ptr<RecordingWriter> create_rosbag(const std::filesystem::path& file, ChunkCompression compression) {
  const auto kind = compression == ChunkCompression::kNone   ? internal::Compression::kNone
                    : compression == ChunkCompression::kFast ? internal::Compression::kLz4
                                                             : internal::Compression::kBz2;
  return std::make_unique<internal::RosbagWriter>(file, kind);
}

}  // namespace loopmark::recordings

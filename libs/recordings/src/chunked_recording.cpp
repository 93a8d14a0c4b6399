// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "chunked_recording.hpp"

#include <zlib.h>

#include <algorithm>

namespace loopmark::recordings::internal {
namespace {

constexpr std::size_t kMostProblems = 20;

std::string place_text(std::uint64_t place) { return "byte " + std::to_string(place); }

}  // namespace

Decompressed ChunkedRecording::decompressed(const ChunkFacts& chunk, bool cut_off_is_fine) const {
  const std::uint64_t left = source_.size() - std::min(source_.size(), chunk.begin);
  const std::uint64_t there = cut_off_is_fine ? std::min(chunk.size, left) : chunk.size;
  Decompressed result = decompress(chunk.compression, source_.exactly(chunk.begin, there), chunk.promised);
  if (there < chunk.size) {
    result.problem = "the file ends within this chunk";
  }
  if (result.problem.empty() && chunk.crc != 0) {
    const auto* bytes = reinterpret_cast<const Bytef*>(result.bytes.data());
    if (crc32_z(0, bytes, result.bytes.size()) != chunk.crc) {
      result.problem = "the checksum of this chunk does not fit its content";
    }
  }
  return result;
}

std::string ChunkedRecording::read(const MessageRef& message) const {
  if (message.block == 0) {
    return source_.exactly(message.offset, message.size);
  }
  const BlockCache::Block block =
      cache_.get(message.block, [&] { return decompressed(chunk_at(message.block), true).bytes; });
  if (message.offset > block->size() || message.size > block->size() - message.offset) {
    throw InputError(source_.path().string(), place_text(message.block), "the chunk is not what it was", "");
  }
  return block->substr(static_cast<std::size_t>(message.offset), message.size);
}

std::string ChunkedRecording::open_chunk(const ChunkFacts& chunk) {
  Decompressed result;
  try {
    result = decompressed(chunk, true);
  } catch (const InputError& error) {
    add_problem(chunk.begin, error.what());
    return "";
  }
  if (!result.problem.empty()) {
    add_problem(chunk.begin, "a damaged chunk: " + result.problem + "; its messages before the damage are used");
  }
  return std::move(result.bytes);
}

void ChunkedRecording::add_problem(std::uint64_t place, const std::string& problem) {
  if (problems_.size() < kMostProblems) {
    problems_.push_back(source_.path().string() + ":" + place_text(place) + ": " + problem);
    return;
  }
  ++more_problems_;
  problems_.resize(kMostProblems);
  problems_.push_back("and " + std::to_string(more_problems_) + " more");
}

void ChunkedRecording::begin_walk() {
  problems_.clear();
  more_problems_ = 0;
}

}  // namespace loopmark::recordings::internal

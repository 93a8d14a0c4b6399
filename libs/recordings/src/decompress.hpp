// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Decompression of blocks that nobody vouches for: the output grows as it comes and stops at what was promised.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace loopmark::recordings::internal {

enum class Compression { kNone, kLz4, kZstd, kBz2 };

struct Decompressed {
  std::string bytes;    ///< what could be had, also where the block is damaged
  std::string problem;  ///< empty: whole
};

/// `promised`: the size that the file states; at most kMostBytes. More than that in the block is a problem of its own.
Decompressed decompress(Compression compression, std::string_view block, std::uint64_t promised);

/// A zstd frame of a size that nobody states; at most kMostBytes.
Decompressed decompress_zstd_message(std::string_view frame);

std::string compress(Compression compression, std::string_view bytes);

}  // namespace loopmark::recordings::internal

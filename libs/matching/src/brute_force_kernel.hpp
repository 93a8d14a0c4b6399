// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The inner loop of the search for nearest descriptors: squared distances of whole numbers, 16 x 16 at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopmark::matching::internal {

/// Descriptors are grouped into chunks of this many near ones, and these into leaves.
constexpr std::size_t kChunk = 16;
constexpr std::size_t kChunks = 8;
constexpr std::size_t kLeaf = kChunk * kChunks;
/// Queries at a time: the words of the targets are loaded once for all of them.
constexpr std::size_t kQueries = 4;
/// Pairs of coordinates that are looked at first: they tell most of a distance, and most are too far already.
constexpr std::size_t kHeadPairs = 6;

/// A chunk of descriptors whose coordinates are 16-bit whole numbers, two to a word.
struct QueryChunk {
  const std::int32_t* words;       ///< [kChunk][pairs]
  const std::int32_t* head_norms;  ///< [kChunk], squared length of the first kHeadPairs
  const std::int32_t* norms;       ///< [kChunk], squared length
  const std::int32_t* limits;      ///< [kChunk], squared distances below this are asked for
};
struct TargetChunk {
  const std::int32_t* words;       ///< [pairs][kChunk], coordinates times -2
  const std::int32_t* head_norms;  ///< [kChunk]
  const std::int32_t* norms;       ///< [kChunk]
  const std::int32_t* limits;      ///< [kChunk], as those of the queries: it suffices to be below either
};

/// For each query the targets whose squared distance is below the query's limit or their own, as bits of hits[kChunk];
/// false when there are none. All squared lengths must be below 2^28.
using ScanChunks = bool (*)(const QueryChunk& queries, const TargetChunk& targets, std::size_t pairs,
                            std::uint16_t* hits);

/// The same for each instruction set; null where the program was not built for it.
ScanChunks scan_chunks_avx512();
ScanChunks scan_chunks_avx2();
ScanChunks scan_chunks_plain();

bool processor_has_avx512();
bool processor_has_avx2();

/// The fastest that this processor has.
ScanChunks scan_chunks();

}  // namespace loopmark::matching::internal

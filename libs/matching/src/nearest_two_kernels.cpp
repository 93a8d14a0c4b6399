// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "nearest_two_kernels.hpp"

#include "loopmark/core/dispatch.hpp"

namespace loopmark::kernels {

LOOPMARK_DISPATCH
float row_distance(const float* a, const float* b, std::size_t padded) {
  using Vector = float __attribute__((vector_size(32), aligned(4)));
  Vector sum{};
  for (std::size_t k = 0; k < padded; k += kRowStep) {
    const Vector d = *reinterpret_cast<const Vector*>(a + k) - *reinterpret_cast<const Vector*>(b + k);
    sum += d * d;
  }
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

LOOPMARK_DISPATCH
void boxes_bounds(const float* q_low, const float* q_high, const float* low, const float* high, std::size_t count,
                  float* __restrict bound) {
  for (std::size_t i = 0; i < count; ++i) {
    bound[i] = 0.0F;
  }
  for (std::size_t d = 0; d < kBound; ++d) {
    const float q_lo = q_low[d];
    const float q_hi = q_high[d];
    const float* lo = low + d * count;
    const float* hi = high + d * count;
    for (std::size_t i = 0; i < count; ++i) {
      const float below = lo[i] - q_hi;
      const float above = q_lo - hi[i];
      float gap = below > above ? below : above;
      gap = gap > 0.0F ? gap : 0.0F;
      bound[i] += gap * gap;
    }
  }
}

LOOPMARK_DISPATCH
void box_bounds(const float* q, const float* low, const float* high, std::size_t count, float* __restrict bound) {
  for (std::size_t i = 0; i < count; ++i) {
    bound[i] = 0.0F;
  }
  for (std::size_t d = 0; d < kBound; ++d) {
    const float value = q[d];
    const float* lo = low + d * count;
    const float* hi = high + d * count;
    for (std::size_t i = 0; i < count; ++i) {
      const float below = lo[i] - value;
      const float above = value - hi[i];
      float gap = below > above ? below : above;
      gap = gap > 0.0F ? gap : 0.0F;
      bound[i] += gap * gap;
    }
  }
}

namespace {

using Boxes = float __attribute__((vector_size(4 * kChunks), aligned(4)));
using Lanes = float __attribute__((vector_size(4 * kChunk), aligned(4)));

/// Adds the squared gaps along some coordinates for the points of a chunk.
template <std::size_t kFrom, std::size_t kTo>
[[gnu::always_inline]] inline void add_gaps(const float* q, const float* chunk, Lanes& bound) {
  for (std::size_t d = kFrom; d < kTo; ++d) {
    const Lanes gap = *reinterpret_cast<const Lanes*>(chunk + d * kChunk) - q[d];
    bound += gap * gap;
  }
}

/// Bounds to the boxes of a leaf's chunks; low and high lie behind each other, [kBound][kChunks] each.
[[gnu::always_inline]] inline void add_bounds_of_chunks(const float* q, const float* boxes, Boxes& bound) {
  for (std::size_t d = 0; d < kBound; ++d) {
    const Boxes below = *reinterpret_cast<const Boxes*>(boxes + d * kChunks) - q[d];
    const Boxes above = q[d] - *reinterpret_cast<const Boxes*>(boxes + (kBound + d) * kChunks);
    Boxes gap = below > above ? below : above;
    gap = gap > 0.0F ? gap : Boxes{};
    bound += gap * gap;
  }
}

/// The lanes that are below the threshold as bits, gathered by OR over the halves of the 64-bit words.
[[gnu::always_inline]] inline std::uint32_t bits_below(const Boxes& bound, float threshold) {
  using Bits = int __attribute__((vector_size(4 * kChunks)));
  using Words = long long __attribute__((vector_size(4 * kChunks)));
  constexpr Bits kBits = {1, 2, 4, 8, 1 << 4, 1 << 5, 1 << 6, 1 << 7};
  const Words any = (Words)((bound < threshold) & kBits);
  const long long both = (any[0] | any[1]) | (any[2] | any[3]);
  return static_cast<std::uint32_t>(both | both >> 32);
}

[[gnu::always_inline]] inline std::uint32_t bits_below(const Lanes& bound, float threshold) {
  using Bits = int __attribute__((vector_size(4 * kChunk)));
  using Words = long long __attribute__((vector_size(4 * kChunk)));
  constexpr Bits kBits = {1,      2,      4,       8,       1 << 4,  1 << 5,  1 << 6,  1 << 7,
                          1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  const Words any = (Words)((bound < threshold) & kBits);
  const long long both = ((any[0] | any[1]) | (any[2] | any[3])) | ((any[4] | any[5]) | (any[6] | any[7]));
  return static_cast<std::uint32_t>(both | both >> 32);
}

}  // namespace

LOOPMARK_DISPATCH
std::size_t leaf_hits(const float* q, const float* leaf, const float* boxes, float threshold, float* __restrict bounds,
                      std::uint8_t* __restrict hits) {
  Boxes of_chunks{};
  add_bounds_of_chunks(q, boxes, of_chunks);
  std::uint64_t words[kLeaf / 64] = {};
  for (std::uint32_t chunks = bits_below(of_chunks, threshold); chunks != 0; chunks &= chunks - 1) {
    const std::size_t c = static_cast<std::size_t>(__builtin_ctz(chunks));
    Lanes bound{};
    const float* chunk = leaf + c * kChunk * kFine;
    add_gaps<0, kHead>(q, chunk, bound);
    add_gaps<kBound, kFine>(q, chunk, bound);
    *reinterpret_cast<Lanes*>(bounds + c * kChunk) = bound;
    words[c / 4] |= static_cast<std::uint64_t>(bits_below(bound, threshold)) << (16 * (c % 4));
  }
  std::size_t count = 0;
  for (std::size_t w = 0; w < kLeaf / 64; ++w) {
    for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
      hits[count++] = static_cast<std::uint8_t>(64 * w + static_cast<std::size_t>(__builtin_ctzll(bits)));
    }
  }
  return count;
}

}  // namespace loopmark::kernels

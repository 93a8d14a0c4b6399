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

LOOPMARK_DISPATCH
std::size_t leaf_hits(const float* q, const float* leaf, float threshold, std::uint8_t* __restrict hits) {
  constexpr std::size_t kChunk = 16;
  using Vector = float __attribute__((vector_size(4 * kChunk), aligned(4)));
  using Lanes = int __attribute__((vector_size(4 * kChunk)));
  constexpr Lanes kLaneBits = {1,      2,      4,       8,       1 << 4,  1 << 5,  1 << 6,  1 << 7,
                               1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  using Words = long long __attribute__((vector_size(4 * kChunk)));
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < kLeaf; begin += kChunk) {
    Vector bound{};
    for (std::size_t d = 0; d < kBound; ++d) {
      const Vector gap = *reinterpret_cast<const Vector*>(leaf + d * kLeaf + begin) - q[d];
      bound += gap * gap;
    }
    // One bit a lane, gathered by OR over the halves of the eight 64-bit words.
    const Words any = (Words)((bound < threshold) & kLaneBits);
    const long long both = ((any[0] | any[1]) | (any[2] | any[3])) | ((any[4] | any[5]) | (any[6] | any[7]));
    for (auto bits = static_cast<std::uint32_t>(both | both >> 32); bits != 0; bits &= bits - 1) {
      hits[count++] = static_cast<std::uint8_t>(begin + static_cast<std::size_t>(__builtin_ctz(bits)));
    }
  }
  return count;
}

}  // namespace loopmark::kernels

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "consistency_kernels.hpp"

#include <bit>

#include "loopmark/core/dispatch.hpp"

namespace loopmark::estimation::internal {

LOOPMARK_DISPATCH
void consistency_row(const PairArrays& pairs, std::size_t i, std::size_t from, float tolerance,
                     std::uint8_t* __restrict consistent) {
  const float *sx = pairs.v[0], *sy = pairs.v[1], *sz = pairs.v[2];
  const float *tx = pairs.v[3], *ty = pairs.v[4], *tz = pairs.v[5];
  // |a - b| < t without roots: a^2 + b^2 < t^2, or (a^2 - b^2)^2 < t^2 (2 (a^2 + b^2) - t^2).
  const float t2 = tolerance * tolerance;
  const float px = sx[i], py = sy[i], pz = sz[i];
  const float qx = tx[i], qy = ty[i], qz = tz[i];
  for (std::size_t j = from; j < pairs.count; ++j) {
    const float ax = sx[j] - px;
    const float ay = sy[j] - py;
    const float az = sz[j] - pz;
    const float bx = tx[j] - qx;
    const float by = ty[j] - qy;
    const float bz = tz[j] - qz;
    const float a2 = ax * ax + ay * ay + az * az;
    const float b2 = bx * bx + by * by + bz * bz;
    const float gap = a2 - b2;
    const float sum = a2 + b2;
    consistent[j] = (sum < t2) | (gap * gap < t2 * (2.0F * sum - t2)) ? 1 : 0;
  }
}

void transpose_bits(std::uint64_t* block) {
  // Quarters off the diagonal change places: of the whole block, then of each of its quarters, and so on.
  std::uint64_t low = 0x00000000FFFFFFFFULL;
  for (std::size_t width = 32; width > 0; width /= 2, low ^= low << width) {
    for (std::size_t r = 0; r < 64; r = (r + width + 1) & ~width) {
      const std::uint64_t swapped = ((block[r] >> width) ^ block[r + width]) & low;
      block[r] ^= swapped << width;
      block[r + width] ^= swapped;
    }
  }
}

LOOPMARK_DISPATCH
std::size_t common_bits(const std::uint64_t* a, const std::uint64_t* b, std::size_t words) {
  std::size_t count = 0;
  for (std::size_t w = 0; w < words; ++w) {
    count += static_cast<std::size_t>(std::popcount(a[w] & b[w]));
  }
  return count;
}

}  // namespace loopmark::estimation::internal

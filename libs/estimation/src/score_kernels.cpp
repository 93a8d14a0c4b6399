// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "score_kernels.hpp"

#include "loopmark/core/dispatch.hpp"

namespace loopmark::estimation::internal {
namespace {

using Vector = float __attribute__((vector_size(4 * kPairLanes), aligned(4)));

}  // namespace

LOOPMARK_DISPATCH
float msac_score(const PairArrays& pairs, const float m[12], float inverse_squared, float best) {
  constexpr std::size_t kCheckEvery = 8 * kPairLanes;
  float total = 0.0F;
  for (std::size_t begin = 0; begin < pairs.count; begin += kCheckEvery) {
    const std::size_t end = begin + kCheckEvery < pairs.count ? begin + kCheckEvery : pairs.count;
    Vector sum{};
    for (std::size_t i = begin; i < end; i += kPairLanes) {
      const Vector x = *reinterpret_cast<const Vector*>(pairs.v[0] + i);
      const Vector y = *reinterpret_cast<const Vector*>(pairs.v[1] + i);
      const Vector z = *reinterpret_cast<const Vector*>(pairs.v[2] + i);
      const Vector dx = m[0] * x + m[1] * y + m[2] * z + (m[3] - *reinterpret_cast<const Vector*>(pairs.v[3] + i));
      const Vector dy = m[4] * x + m[5] * y + m[6] * z + (m[7] - *reinterpret_cast<const Vector*>(pairs.v[4] + i));
      const Vector dz = m[8] * x + m[9] * y + m[10] * z + (m[11] - *reinterpret_cast<const Vector*>(pairs.v[5] + i));
      const Vector gain = 1.0F - (dx * dx + dy * dy + dz * dz) * inverse_squared;
      const Vector none{};
      sum += gain > none ? gain : none;
    }
    float block = 0.0F;
    for (std::size_t l = 0; l < kPairLanes; ++l) {
      block += sum[l];
    }
    total += block;
    if (total + static_cast<float>(pairs.count - end) <= best) {
      return total < best ? total : best;
    }
  }
  return total;
}

}  // namespace loopmark::estimation::internal

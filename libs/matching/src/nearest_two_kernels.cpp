// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "nearest_two_kernels.hpp"

#include "loopmark/core/dispatch.hpp"

namespace loopmark::matching::internal {

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
void round_products(const float* x, std::size_t count, float factor, float largest, std::int32_t* __restrict whole) {
  for (std::size_t i = 0; i < count; ++i) {
    float product = x[i] * factor;
    product = product < largest ? product : largest;
    product = product > -largest ? product : -largest;
    whole[i] = static_cast<std::int32_t>(product + (product < 0.0F ? -0.5F : 0.5F));
  }
}

LOOPMARK_DISPATCH
void box_bounds(const float* q_low, const float* q_high, const float* low, const float* high, std::size_t count,
                float* __restrict bound) {
  for (std::size_t i = 0; i < count; ++i) {
    bound[i] = 0.0F;
  }
  for (std::size_t d = 0; d < kBox; ++d) {
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

}  // namespace loopmark::matching::internal

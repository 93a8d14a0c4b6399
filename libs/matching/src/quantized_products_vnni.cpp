// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "quantized_products.hpp"

#ifdef __AVX512VNNI__

#include <immintrin.h>

#include <cstring>

namespace loopmark::matching::internal {
namespace {

__m512i four_of(const std::int8_t* p) {
  std::int32_t word;
  std::memcpy(&word, p, sizeof word);
  return _mm512_set1_epi32(word);
}

/// dpbusd multiplies unsigned by signed numbers: with b + 128 for b, 128 times the sum of a comes off again.
void products_vnni(const std::int8_t* a, const std::int32_t* row_sums, const std::int8_t* b, std::size_t length,
                   std::int32_t* products) {
  const __m512i shift = _mm512_set1_epi8(static_cast<char>(0x80));
  __m512i sums[kProductRows];
  for (std::size_t q = 0; q < kProductRows; ++q) {
    sums[q] = _mm512_set1_epi32(-128 * row_sums[q]);
  }
  for (std::size_t i = 0; i < length; i += kProductStep) {
    const __m512i lanes = _mm512_xor_si512(_mm512_loadu_si512(b + i * kProductLanes), shift);
    for (std::size_t q = 0; q < kProductRows; ++q) {
      sums[q] = _mm512_dpbusd_epi32(sums[q], lanes, four_of(a + q * length + i));
    }
  }
  for (std::size_t q = 0; q < kProductRows; ++q) {
    _mm512_storeu_si512(products + q * kProductLanes, sums[q]);
  }
}

}  // namespace

QuantizedProducts quantized_products_vnni() { return products_vnni; }

}  // namespace loopmark::matching::internal

#else

namespace loopmark::matching::internal {

QuantizedProducts quantized_products_vnni() { return nullptr; }

}  // namespace loopmark::matching::internal

#endif

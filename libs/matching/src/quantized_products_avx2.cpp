// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "quantized_products.hpp"

#ifdef __AVX2__

#include <immintrin.h>

#include <cstring>

namespace loopmark::matching::internal {
namespace {

constexpr std::size_t kHalf = kProductLanes / 2;
constexpr std::size_t kRowsAtOnce = 4;

__m256i four_of(const std::int8_t* p) {
  std::int32_t word;
  std::memcpy(&word, p, sizeof word);
  return _mm256_set1_epi32(word);
}

/// |b| (a sgn b): two products of numbers up to 127 fit into 16 bits, those of unsigned ones would not.
__m256i products_of_four(__m256i a, __m256i b, __m256i size_of_b) {
  const __m256i pairs = _mm256_maddubs_epi16(size_of_b, _mm256_sign_epi8(a, b));
  return _mm256_madd_epi16(pairs, _mm256_set1_epi16(1));
}

void products_avx2(const std::int8_t* a, const std::int32_t* /*sums*/, const std::int8_t* b, std::size_t length,
                   std::int32_t* products) {
  for (std::size_t first = 0; first < kProductRows; first += kRowsAtOnce) {
    for (std::size_t half = 0; half < kProductLanes; half += kHalf) {
      __m256i sums[kRowsAtOnce] = {};
      for (std::size_t i = 0; i < length; i += kProductStep) {
        const __m256i lanes =
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(b + i * kProductLanes + half * kProductStep));
        const __m256i size = _mm256_abs_epi8(lanes);
        for (std::size_t q = 0; q < kRowsAtOnce; ++q) {
          sums[q] = _mm256_add_epi32(sums[q], products_of_four(four_of(a + (first + q) * length + i), lanes, size));
        }
      }
      for (std::size_t q = 0; q < kRowsAtOnce; ++q) {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(products + (first + q) * kProductLanes + half), sums[q]);
      }
    }
  }
}

}  // namespace

QuantizedProducts quantized_products_avx2() { return products_avx2; }

}  // namespace loopmark::matching::internal

#else

namespace loopmark::matching::internal {

QuantizedProducts quantized_products_avx2() { return nullptr; }

}  // namespace loopmark::matching::internal

#endif

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "brute_force_kernel.hpp"

#ifdef __AVX512BW__

#include <immintrin.h>

#include "brute_force_kernel_body.hpp"

namespace loopmark::matching::internal {
namespace {

struct Avx512 {
  using Vector = __m512i;
  static constexpr std::size_t kLanes = 16;
  static Vector load(const std::int32_t* p) { return _mm512_loadu_si512(p); }
  static Vector spread(std::int32_t x) { return _mm512_set1_epi32(x); }
  static Vector add(Vector a, Vector b) { return _mm512_add_epi32(a, b); }
  static Vector subtract(Vector a, Vector b) { return _mm512_sub_epi32(a, b); }
  static Vector larger(Vector a, Vector b) { return _mm512_max_epi32(a, b); }
  static Vector multiply_pairs(Vector a, Vector b) { return _mm512_madd_epi16(a, b); }
  static std::uint32_t less(Vector a, Vector b) { return _mm512_cmplt_epi32_mask(a, b); }
};

}  // namespace

ScanChunks scan_chunks_avx512() { return scan<Avx512>; }

}  // namespace loopmark::matching::internal

#else

namespace loopmark::matching::internal {

ScanChunks scan_chunks_avx512() { return nullptr; }

}  // namespace loopmark::matching::internal

#endif

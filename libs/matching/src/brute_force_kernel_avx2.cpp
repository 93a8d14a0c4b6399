// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "brute_force_kernel.hpp"

#ifdef __AVX2__

#include <immintrin.h>

#include "brute_force_kernel_body.hpp"

namespace loopmark::matching::internal {
namespace {

struct Avx2 {
  using Vector = __m256i;
  static constexpr std::size_t kLanes = 8;
  static Vector load(const std::int32_t* p) { return _mm256_loadu_si256(reinterpret_cast<const Vector*>(p)); }
  static Vector spread(std::int32_t x) { return _mm256_set1_epi32(x); }
  static Vector add(Vector a, Vector b) { return _mm256_add_epi32(a, b); }
  static Vector subtract(Vector a, Vector b) { return _mm256_sub_epi32(a, b); }
  static Vector larger(Vector a, Vector b) { return _mm256_max_epi32(a, b); }
  static Vector multiply_pairs(Vector a, Vector b) { return _mm256_madd_epi16(a, b); }
  static std::uint32_t less(Vector a, Vector b) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a))));
  }
};

}  // namespace

ScanChunks scan_chunks_avx2() { return scan<Avx2>; }

}  // namespace loopmark::matching::internal

#else

namespace loopmark::matching::internal {

ScanChunks scan_chunks_avx2() { return nullptr; }

}  // namespace loopmark::matching::internal

#endif

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "brute_force_kernel.hpp"

#include <algorithm>

#include "brute_force_kernel_body.hpp"

namespace loopmark::matching::internal {
namespace {

/// One lane, for any processor.
struct Plain {
  using Vector = std::int32_t;
  static constexpr std::size_t kLanes = 1;
  static Vector load(const std::int32_t* p) { return *p; }
  static Vector spread(std::int32_t x) { return x; }
  static Vector add(Vector a, Vector b) { return a + b; }
  static Vector subtract(Vector a, Vector b) { return a - b; }
  static Vector larger(Vector a, Vector b) { return std::max(a, b); }
  static Vector multiply_pairs(Vector a, Vector b) {
    const auto low = [](Vector x) { return static_cast<std::int32_t>(static_cast<std::int16_t>(x & 0xFFFF)); };
    return low(a) * low(b) + (a >> 16) * (b >> 16);
  }
  static std::uint32_t less(Vector a, Vector b) { return a < b ? 1U : 0U; }
};

}  // namespace

#if defined(__x86_64__)
bool processor_has_avx512() { return __builtin_cpu_supports("avx512bw") != 0; }
bool processor_has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
#else
bool processor_has_avx512() { return false; }
bool processor_has_avx2() { return false; }
#endif

ScanChunks scan_chunks_plain() { return scan<Plain>; }

ScanChunks scan_chunks() {
  if (processor_has_avx512() && scan_chunks_avx512() != nullptr) {
    return scan_chunks_avx512();
  }
  if (processor_has_avx2() && scan_chunks_avx2() != nullptr) {
    return scan_chunks_avx2();
  }
  return scan_chunks_plain();
}

}  // namespace loopmark::matching::internal

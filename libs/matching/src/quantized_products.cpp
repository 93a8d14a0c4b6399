// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "quantized_products.hpp"

#include <algorithm>

#include "brute_force_kernel.hpp"

namespace loopmark::matching::internal {
namespace {

void plain(const std::int8_t* a, const std::int32_t* /*sums*/, const std::int8_t* b, std::size_t length,
           std::int32_t* products) {
  std::fill_n(products, kProductRows * kProductLanes, 0);
  for (std::size_t i = 0; i < length; ++i) {
    const std::int8_t* lanes = b + i / kProductStep * kProductStep * kProductLanes + i % kProductStep;
    for (std::size_t q = 0; q < kProductRows; ++q) {
      for (std::size_t l = 0; l < kProductLanes; ++l) {
        products[q * kProductLanes + l] += a[q * length + i] * lanes[l * kProductStep];
      }
    }
  }
}

}  // namespace

#if defined(__x86_64__)
bool processor_has_vnni() {
  return __builtin_cpu_supports("avx512vnni") != 0 && __builtin_cpu_supports("avx512bw") != 0;
}
#else
bool processor_has_vnni() { return false; }
#endif

QuantizedProducts quantized_products_plain() { return plain; }

QuantizedProducts quantized_products() {
  if (processor_has_vnni() && quantized_products_vnni() != nullptr) {
    return quantized_products_vnni();
  }
  if (processor_has_avx2() && quantized_products_avx2() != nullptr) {
    return quantized_products_avx2();
  }
  return quantized_products_plain();
}

}  // namespace loopmark::matching::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The inner loop of the search for nearest quantised descriptors: scalar products of 8-bit whole numbers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopmark::matching::internal {

constexpr std::size_t kProductRows = 8;    ///< rows of the one side at a time
constexpr std::size_t kProductLanes = 16;  ///< rows of the other side at a time
constexpr std::size_t kProductStep = 4;    ///< lengths are multiples of this many numbers

/// products[q][l] = sum over i of a[q][i] b[l][i]. `a`: [kProductRows][length]; `b`: interleaved, as
/// [length / kProductStep][kProductLanes][kProductStep]; all numbers from -127 to 127. `sums`: of the numbers of each
/// row of a.
using QuantizedProducts = void (*)(const std::int8_t* a, const std::int32_t* sums, const std::int8_t* b,
                                   std::size_t length, std::int32_t* products);

/// The same for each instruction set; null where the program was not built for it.
QuantizedProducts quantized_products_vnni();
QuantizedProducts quantized_products_avx2();
QuantizedProducts quantized_products_plain();

/// Whether this processor has the instructions.
bool processor_has_vnni();

/// The fastest that this processor has.
QuantizedProducts quantized_products();

}  // namespace loopmark::matching::internal

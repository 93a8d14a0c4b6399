// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "score_kernels.hpp"

namespace loopmark::kernels {

/// consistent[j] = 1 where the distances of pairs i and j differ by less than the tolerance, else 0.
void consistency_row(const PairArrays& pairs, std::size_t i, float tolerance, std::uint8_t* consistent);

/// Number of bits set in both.
std::size_t common_bits(const std::uint64_t* a, const std::uint64_t* b, std::size_t words);

}  // namespace loopmark::kernels

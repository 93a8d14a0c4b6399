// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "score_kernels.hpp"

namespace loopmark::estimation::internal {

/// consistent[j] = 1 where the distances of pairs i and j differ by less than the tolerance, else 0; from j = `from`
/// on.
void consistency_row(const PairArrays& pairs, std::size_t i, std::size_t from, float tolerance,
                     std::uint8_t* consistent);

/// Turns a block of 64 x 64 bits over its diagonal: bit c of word r becomes bit r of word c.
void transpose_bits(std::uint64_t* block);

/// Number of bits set in both.
std::size_t common_bits(const std::uint64_t* a, const std::uint64_t* b, std::size_t words);

}  // namespace loopmark::estimation::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopmark::kernels {

/// Descriptors are grouped into leaves of this many.
constexpr std::size_t kLeaf = 128;
/// Principal coordinates used for bounds, and behind them one more: the length of the rest.
constexpr std::size_t kHead = 8;
constexpr std::size_t kBound = kHead + 1;
/// Rows are filled up to a multiple of this many floats.
constexpr std::size_t kRowStep = 8;

/// Squared distance of two padded rows, the same bits on every processor.
float row_distance(const float* a, const float* b, std::size_t padded);

/// Lower bounds of the squared distance from q[kBound] to `count` boxes; low and high are [kBound][count].
void box_bounds(const float* q, const float* low, const float* high, std::size_t count, float* bound);

/// Lower bounds to the kLeaf points of one leaf, [kBound][kLeaf]; writes the lanes whose bound is below the
/// threshold to `hits` and returns their number.
std::size_t leaf_hits(const float* q, const float* leaf, float threshold, std::uint8_t* hits);

}  // namespace loopmark::kernels

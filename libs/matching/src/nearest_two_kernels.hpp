// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopmark::matching::internal {

/// Principal coordinates used for boxes.
constexpr std::size_t kBox = 12;
/// Rows are filled up to a multiple of this many floats.
constexpr std::size_t kRowStep = 8;

/// Squared distance of two padded rows, the same bits on every processor.
float row_distance(const float* a, const float* b, std::size_t padded);

/// Rounds the products of `count` finite numbers and a factor to whole numbers, up to `largest` in size.
void round_products(const float* x, std::size_t count, float factor, float largest, std::int32_t* whole);

/// Lower bounds of the squared distance from anything in a box (q_low, q_high [kBox]) to what is in `count` boxes; low
/// and high are [kBox][count].
void box_bounds(const float* q_low, const float* q_high, const float* low, const float* high, std::size_t count,
                float* bound);

}  // namespace loopmark::matching::internal

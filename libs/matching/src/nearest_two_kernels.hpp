// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopmark::kernels {

/// Descriptors are grouped into leaves of this many.
constexpr std::size_t kLeaf = 128;
/// Within a leaf near ones stand together in chunks, each with a box of its own.
constexpr std::size_t kChunk = 16;
constexpr std::size_t kChunks = kLeaf / kChunk;
/// Principal coordinates used for bounds, and behind them one more: the length of the rest.
constexpr std::size_t kHead = 8;
constexpr std::size_t kBound = kHead + 1;
/// Further principal coordinates and the length of what then is left, for a second, tighter bound of points.
constexpr std::size_t kMore = 4;
constexpr std::size_t kFine = kBound + kMore + 1;
/// Rows are filled up to a multiple of this many floats.
constexpr std::size_t kRowStep = 8;

/// Squared distance of two padded rows, the same bits on every processor.
float row_distance(const float* a, const float* b, std::size_t padded);

/// Lower bounds of the squared distance from anything in a box (q_low, q_high [kBound]) to `count` boxes, as below.
void boxes_bounds(const float* q_low, const float* q_high, const float* low, const float* high, std::size_t count,
                  float* bound);

/// Lower bounds of the squared distance from q[kBound] to `count` boxes; low and high are [kBound][count].
void box_bounds(const float* q, const float* low, const float* high, std::size_t count, float* bound);

/// Lower bounds to the points of one leaf, chunk by chunk [kFine][kChunk], in those chunks whose box is below the
/// threshold; boxes are low and high, [kBound][kChunks] each. Writes the lanes whose bound is below the threshold to
/// `hits`, the bound of each to its place in bounds[kLeaf], and returns their number.
std::size_t leaf_hits(const float* q, const float* leaf, const float* boxes, float threshold, float* bounds,
                      std::uint8_t* hits);

}  // namespace loopmark::kernels

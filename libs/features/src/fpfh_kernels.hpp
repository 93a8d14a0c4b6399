// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopmark::features::internal {

constexpr std::size_t kFpfhBins = 11;
/// Floats of one padded histogram row: 33 bins and zeros.
constexpr std::size_t kFpfhRow = 40;
/// The bin of a pair that has no features.
constexpr std::uint8_t kNoBin = 11;

/// Squared distances from q to the candidates.
void squared_distances(const float* x, const float* y, const float* z, std::size_t count, const float q[3],
                       float* squared);

/// A point and its normal.
struct OrientedPoint {
  float p[3];
  float n[3];
};

/// Neighbours of one point, side by side; `count` rounded up to whole lanes must be readable.
struct NeighbourArrays {
  const float *x, *y, *z, *nx, *ny, *nz, *squared;
};

/// The bins of the three angles of the pair features (PFH, Rusu 2009, eq. 1-3) of the point with each neighbour.
void pair_bins(const OrientedPoint& point, const NeighbourArrays& to, std::size_t count, std::uint8_t* theta,
               std::uint8_t* alpha, std::uint8_t* phi);

/// sum[b] = sum over k of weight[k] * rows[kFpfhRow * row[k] + b].
void weighted_sum(const float* rows, const std::uint32_t* row, const float* weight, std::size_t count,
                  float sum[kFpfhRow]);

}  // namespace loopmark::features::internal

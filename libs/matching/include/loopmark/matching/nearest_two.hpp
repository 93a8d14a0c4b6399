// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::matching {

constexpr std::uint32_t kNoNeighbour = std::numeric_limits<std::uint32_t>::max();

/// The two nearest rows of another matrix for one row; kNoNeighbour and infinity where there is none.
struct NearestTwo {
  std::uint32_t first = kNoNeighbour;
  std::uint32_t second = kNoNeighbour;
  float first_squared = std::numeric_limits<float>::infinity();
  float second_squared = std::numeric_limits<float>::infinity();
};

struct TwoWayNearest {
  std::vector<NearestTwo> forward;   ///< for each source row, in the target
  std::vector<NearestTwo> backward;  ///< for each target row, in the source
};

/// Exact nearest and second nearest neighbours (L2) in both directions. Rows that are zero or not finite are nobody's
/// neighbour and have none. Among equal distances the lower row wins. Distances are sums of squared float
/// differences, not |a|^2 + |b|^2 - 2ab, whose rounding would exchange near-equal neighbours.
/// Throws std::invalid_argument when the two matrices have different numbers of columns.
TwoWayNearest nearest_two(const search::DescriptorMatrix& source, const search::DescriptorMatrix& target);

/// The same for quantised descriptors (numbers from -127 to 127), by brute force on whole numbers: exact.
TwoWayNearest nearest_two(const search::QuantizedDescriptors& source, const search::QuantizedDescriptors& target);

/// The same for either. Throws std::invalid_argument when one is quantised and the other not, unless one is empty.
TwoWayNearest nearest_two(const search::DescriptorRows& source, const search::DescriptorRows& target);

}  // namespace loopmark::matching

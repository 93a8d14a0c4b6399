// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <variant>

namespace loopmark::search {

/// Descriptors of points, one row a point.
using DescriptorMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The same in whole numbers from -127 to 127: a quarter of the memory, and exact to compare.
using QuantizedDescriptors = Eigen::Matrix<std::int8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Either of them.
using DescriptorRows = std::variant<DescriptorMatrix, QuantizedDescriptors>;

}  // namespace loopmark::search

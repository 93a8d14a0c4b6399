// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::matching::internal {

/// The principal directions of descriptors: a rotation, which leaves distances as they are, after which the first few
/// coordinates tell most of a distance.
struct PrincipalFrame {
  Eigen::RowVectorXf mean;
  Eigen::MatrixXf rotation;  ///< one column a direction, that of the largest variance first

  /// Of a few thousand rows of both.
  static PrincipalFrame of(const search::DescriptorMatrix& a, const search::DescriptorMatrix& b);

  /// (row - mean) * rotation.
  search::DescriptorMatrix rotated(const search::DescriptorMatrix& rows) const;
};

/// Whether a row takes part: finite and not all zero.
bool is_usable(const search::DescriptorMatrix& rows, Eigen::Index r);

}  // namespace loopmark::matching::internal

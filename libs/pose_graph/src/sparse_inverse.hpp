// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::pose_graph::internal {

/// The 6x6 diagonal blocks of the inverse of a sparse positive definite matrix, without forming the inverse: only
/// the entries on the pattern of its Cholesky factor are computed (Takahashi, Fagan, Chen 1973; Erisman and
/// Tinney 1975). Throws std::runtime_error when the matrix is singular.
std::vector<Matrix6d> inverse_diagonal_blocks(const Eigen::SparseMatrix<double>& matrix);

}  // namespace loopmark::pose_graph::internal

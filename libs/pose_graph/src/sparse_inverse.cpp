// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_inverse.hpp"

#include <Eigen/SparseCholesky>
#include <stdexcept>

namespace loopmark::pose_graph::internal {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Z = (L D L^T)^-1 on the pattern of L: columns from the last to the first,
///   Z(i, j) = -sum over k > j in column j of L of Z(i, k) * L(k, j)   for i > j,
///   Z(j, j) = 1 / D(j) - sum over k of L(k, j) * Z(k, j).
/// A column of Z is scattered into `dense` so that entries are found in constant time.
class InverseSubset {
 public:
  InverseSubset(const Sparse& lower, const Eigen::VectorXd& diagonal)
      : lower_(lower), inverse_(lower), z_diagonal_(diagonal.size()) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(diagonal.size());
    for (Eigen::Index j = diagonal.size() - 1; j >= 0; --j) {
      compute_column(j, diagonal[j], column);
    }
  }

  /// Entry of the inverse on the pattern, any order of indices.
  double at(Eigen::Index i, Eigen::Index j) const {
    return i == j ? z_diagonal_[i] : inverse_.coeff(std::max(i, j), std::min(i, j));
  }

 private:
  void compute_column(Eigen::Index j, double pivot, Eigen::VectorXd& sums) {
    // sums[i] = sum over k of Z(i, k) L(k, j) for i in the pattern of column j, each Z(i, k) used from the lower half.
    for (Sparse::InnerIterator k(lower_, j); k; ++k) {
      sums[k.row()] += z_diagonal_[k.row()] * k.value();
    }
    for (Sparse::InnerIterator k(lower_, j); k; ++k) {
      add_column(k.row(), k.value(), j, sums);
    }
    double z_jj = 1.0 / pivot;
    Sparse::InnerIterator l(lower_, j);
    for (Sparse::InnerIterator z(inverse_, j); z; ++z, ++l) {
      z.valueRef() = -sums[z.row()];
      z_jj -= l.value() * z.valueRef();
      sums[z.row()] = 0.0;
    }
    z_diagonal_[j] = z_jj;
  }

  /// Adds the pairs (i, k), i > k, both in the pattern of column j, to both of their sums: a merge of two sorted lists.
  void add_column(Eigen::Index k, double l_kj, Eigen::Index j, Eigen::VectorXd& sums) {
    Sparse::InnerIterator z(inverse_, k);
    Sparse::InnerIterator l(lower_, j);
    while (z && l) {
      if (z.row() < l.row()) {
        ++z;
      } else if (l.row() < z.row()) {
        ++l;
      } else {
        sums[z.row()] += z.value() * l_kj;
        sums[k] += z.value() * l.value();
        ++z;
        ++l;
      }
    }
  }

  const Sparse& lower_;
  Sparse inverse_;
  Eigen::VectorXd z_diagonal_;
};

/// The strictly lower part, compressed and sorted.
Sparse strictly_lower(const Sparse& l) {
  Sparse strict = l.triangularView<Eigen::StrictlyLower>();
  strict.makeCompressed();
  return strict;
}

}  // namespace

std::vector<Matrix6d> inverse_diagonal_blocks(const Sparse& matrix) {
  if (matrix.rows() == 0) {
    return {};
  }
  const Eigen::SimplicialLDLT<Sparse> factor(matrix);
  if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() <= 0.0) {
    throw std::runtime_error("the pose graph leaves a direction without any constraint");
  }
  const Sparse lower = strictly_lower(factor.matrixL().nestedExpression());
  const InverseSubset inverse(lower, factor.vectorD());
  // A * P^-1 = P^-1 * ordered: permutationP maps a row of the matrix to its row in the factor.
  const auto& place = factor.permutationP().indices();
  std::vector<Matrix6d> blocks(static_cast<std::size_t>(matrix.rows() / 6));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (Eigen::Index r = 0; r < 6; ++r) {
      for (Eigen::Index c = 0; c < 6; ++c) {
        const auto base = static_cast<Eigen::Index>(6 * b);
        blocks[b](r, c) = inverse.at(place[base + r], place[base + c]);
      }
    }
  }
  return blocks;
}

}  // namespace loopmark::pose_graph::internal

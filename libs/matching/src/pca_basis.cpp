// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pca_basis.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

namespace loopmark::matching::internal {
namespace {

constexpr Eigen::Index kSampled = 1500;  // rows of each matrix: enough to find the directions

void add_sample(const search::DescriptorMatrix& m, std::vector<Eigen::VectorXd>& sample) {
  const Eigen::Index step = std::max<Eigen::Index>(1, m.rows() / kSampled);
  for (Eigen::Index r = 0; r < m.rows(); r += step) {
    if (is_usable(m, r)) {
      sample.emplace_back(m.row(r).transpose().cast<double>());
    }
  }
}

}  // namespace

bool is_usable(const search::DescriptorMatrix& rows, Eigen::Index r) {
  const float largest = rows.row(r).lpNorm<Eigen::Infinity>();
  return largest > 0.0F && (rows.row(r) * 0.0F).squaredNorm() == 0.0F;  // NaN where one is not finite
}

PrincipalFrame PrincipalFrame::of(const search::DescriptorMatrix& a, const search::DescriptorMatrix& b) {
  std::vector<Eigen::VectorXd> sample;
  add_sample(a, sample);
  add_sample(b, sample);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(a.cols());
  for (const Eigen::VectorXd& row : sample) {
    mean += row / static_cast<double>(sample.size());
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(a.cols(), a.cols());
  for (const Eigen::VectorXd& row : sample) {
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(row - mean);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return {mean.transpose().cast<float>(), solver.eigenvectors().rowwise().reverse().cast<float>()};
}

search::DescriptorMatrix PrincipalFrame::rotated(const search::DescriptorMatrix& rows) const {
  return (rows.rowwise() - mean) * rotation;
}

}  // namespace loopmark::matching::internal

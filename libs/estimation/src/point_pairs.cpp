// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/estimation/point_pairs.hpp"

#include <Eigen/SVD>

namespace loopmark::estimation {

PointPairs PointPairs::of(const matching::Correspondences& matches, const std::vector<Eigen::Vector3f>& source,
                          const std::vector<Eigen::Vector3f>& target) {
  PointPairs pairs;
  pairs.source.reserve(matches.size());
  pairs.target.reserve(matches.size());
  for (const matching::Correspondence& match : matches) {
    pairs.source.push_back(source.at(match.source));
    pairs.target.push_back(target.at(match.target));
  }
  return pairs;
}

Pose fit_rigid(const PointPairs& pairs, const std::vector<std::size_t>& indices, const std::vector<double>& weights) {
  Eigen::Vector3d p_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d q_mean = Eigen::Vector3d::Zero();
  double total = 0.0;
  const auto weight = [&](std::size_t k) { return weights.empty() ? 1.0 : weights[k]; };
  for (std::size_t k = 0; k < indices.size(); ++k) {
    p_mean += weight(k) * pairs.source[indices[k]].cast<double>();
    q_mean += weight(k) * pairs.target[indices[k]].cast<double>();
    total += weight(k);
  }
  Pose T = Pose::Identity();
  if (!(total > 0.0)) {
    return T;
  }
  p_mean /= total;
  q_mean /= total;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < indices.size(); ++k) {
    covariance += weight(k) * (pairs.target[indices[k]].cast<double>() - q_mean) *
                  (pairs.source[indices[k]].cast<double>() - p_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  T.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  T.translation() = q_mean - T.linear() * p_mean;
  return T;
}

double squared_residual(const PointPairs& pairs, std::size_t i, const Pose& T_target_source) {
  return (T_target_source * pairs.source[i].cast<double>() - pairs.target[i].cast<double>()).squaredNorm();
}

std::vector<std::size_t> inliers_of(const PointPairs& pairs, const Pose& T_target_source, double threshold_m) {
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (squared_residual(pairs, i, T_target_source) < threshold_m * threshold_m) {
      inliers.push_back(i);
    }
  }
  return inliers;
}

Pose reweighted_fit(const PointPairs& pairs, const Pose& initial, double threshold_m, int iterations) {
  Pose T = initial;
  for (int k = 0; k < iterations; ++k) {
    const std::vector<std::size_t> inliers = inliers_of(pairs, T, threshold_m);
    if (inliers.size() < 3) {
      return T;
    }
    std::vector<double> weights;
    for (const std::size_t i : inliers) {
      const double u = 1.0 - squared_residual(pairs, i, T) / (threshold_m * threshold_m);
      weights.push_back(u * u);
    }
    const Pose next = fit_rigid(pairs, inliers, weights);
    const bool still = (next.matrix() - T.matrix()).cwiseAbs().maxCoeff() < 1e-9;
    T = next;
    if (still) {
      break;
    }
  }
  return T;
}

}  // namespace loopmark::estimation

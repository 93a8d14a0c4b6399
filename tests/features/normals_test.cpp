// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/normals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "loopmark/core/parallel.hpp"
#include "rough_yard.hpp"

namespace loopmark::features {
namespace {

using testing_support::rough_yard;

Eigen::Vector3d brute_force_normal(const std::vector<Eigen::Vector3f>& points, std::size_t i, double radius) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> near;
  for (const Eigen::Vector3f& p : points) {
    if ((p - points[i]).norm() < radius) {
      near.push_back(p.cast<double>());
      mean += near.back();
    }
  }
  mean /= static_cast<double>(near.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : near) {
    covariance += (p - mean) * (p - mean).transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

TEST(Normals, AreThoseOfTheBruteForceAnalysis) {
  const auto points = rough_yard(3000, 1);
  NormalOptions options;
  options.radius_m = 0.8;
  const Normals normals = estimate_normals(points, options);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < points.size(); i += 7) {
    if (normals.vectors[i].isZero() || normals.curvature[i] > 0.2F) {
      continue;
    }
    const Eigen::Vector3d expected = brute_force_normal(points, i, 0.8);
    EXPECT_GT(std::abs(expected.dot(normals.vectors[i].cast<double>())), 0.9999);
    ++compared;
  }
  EXPECT_GT(compared, 300U);
}

TEST(Normals, LookAtTheSensor) {
  const auto points = rough_yard(2000, 2);
  const Eigen::Vector3f sensor(1, -2, 3);
  for (const std::size_t neighbours : {std::size_t{0}, std::size_t{20}}) {
    NormalOptions options;
    options.neighbours = neighbours;
    const Normals normals = estimate_normals(points, options, sensor);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_GE(normals.vectors[i].dot(sensor - points[i]), 0.0F);
    }
  }
}

TEST(Normals, NearestNeighboursFindThePlaneToo) {
  Rng rng(3);
  const Eigen::Vector3d n = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Vector3d a = n.unitOrthogonal();
  const Eigen::Vector3d b = n.cross(a);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 400; ++i) {
    points.push_back((5.0 * n + rng.uniform(-3, 3) * a + rng.uniform(-3, 3) * b).cast<float>());
  }
  NormalOptions options;
  options.neighbours = 12;
  const Normals normals = estimate_normals(points, options);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GT(-n.dot(normals.vectors[i].cast<double>()), 0.9999);
    EXPECT_LT(normals.curvature[i], 1e-5F);
  }
}

TEST(Normals, LonelyAndBrokenPointsGetNone) {
  std::vector<Eigen::Vector3f> points = rough_yard(500, 4);
  points.push_back({1000, 0, 0});
  points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  for (const std::size_t neighbours : {std::size_t{0}, std::size_t{10}}) {
    NormalOptions options;
    options.neighbours = neighbours;
    const Normals normals = estimate_normals(points, options);
    ASSERT_EQ(normals.vectors.size(), points.size());
    EXPECT_TRUE(normals.vectors.back().isZero());
    EXPECT_EQ(normals.vectors[points.size() - 2].isZero(), neighbours == 0);
  }
  EXPECT_TRUE(estimate_normals({}, {}).vectors.empty());
}

TEST(Normals, SameBytesAtAnyNumberOfThreads) {
  const auto points = rough_yard(4000, 5);
  set_thread_count(1);
  const Normals one = estimate_normals(points, {});
  set_thread_count(4);
  const Normals four = estimate_normals(points, {});
  set_thread_count(0);
  EXPECT_EQ(one.vectors, four.vectors);
}

TEST(Normals, RefusesOptionsThatMakeNoSense) {
  NormalOptions options;
  options.radius_m = 0.0;
  EXPECT_THROW(estimate_normals({}, options), InputError);
}

}  // namespace
}  // namespace loopmark::features

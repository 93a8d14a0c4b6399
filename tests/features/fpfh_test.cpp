// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/fpfh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/pose.hpp"
#include "loopmark/features/normals.hpp"
#include "rough_yard.hpp"

namespace loopmark::features {
namespace {

using testing_support::rough_yard;

/// Pair features by their definition, in double: theta, alpha, phi.
bool pair_features(const Eigen::Vector3d& p, const Eigen::Vector3d& n, const Eigen::Vector3d& q,
                   const Eigen::Vector3d& m, Eigen::Vector3d& f) {
  Eigen::Vector3d d = (q - p).normalized();
  Eigen::Vector3d u = n;
  Eigen::Vector3d other = m;
  if (std::abs(n.dot(d)) < std::abs(m.dot(d))) {
    u = m;
    other = n;
    d = -d;
  }
  const Eigen::Vector3d v = d.cross(u).normalized();
  if (n.isZero() || m.isZero() || !(d.cross(u).norm() > 1e-9)) {
    return false;
  }
  const Eigen::Vector3d w = u.cross(v);
  f = {std::atan2(w.dot(other), u.dot(other)), v.dot(other), u.dot(d)};
  return true;
}

Eigen::VectorXd reference_spfh(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                               std::size_t i, double radius) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(33);
  for (std::size_t j = 0; j < points.size(); ++j) {
    Eigen::Vector3d f;
    if (j == i || (points[j] - points[i]).norm() >= radius ||
        !pair_features(points[i].cast<double>(), normals[i].cast<double>(), points[j].cast<double>(),
                       normals[j].cast<double>(), f)) {
      continue;
    }
    const auto bin = [](double unit) { return std::clamp(static_cast<int>(std::floor(11.0 * unit)), 0, 10); };
    h[bin((f[0] + M_PI) / (2.0 * M_PI))] += 1.0;
    h[11 + bin(0.5 * (f[1] + 1.0))] += 1.0;
    h[22 + bin(0.5 * (f[2] + 1.0))] += 1.0;
  }
  return h / std::max(1.0, h.sum() / 3.0);
}

TEST(Fpfh, IsThatOfTheDefinition) {
  const auto points = rough_yard(2500, 1);
  const auto normals = estimate_normals(points, {}).vectors;
  FpfhOptions options;
  options.radius_m = 1.5;
  const search::DescriptorMatrix found = fpfh(points, normals, options);
  std::vector<Eigen::VectorXd> spfh(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    spfh[i] = reference_spfh(points, normals, i, options.radius_m);
  }
  std::size_t compared = 0;
  std::size_t same = 0;
  for (std::size_t i = 0; i < points.size(); i += 5) {
    if (normals[i].isZero()) {
      EXPECT_TRUE(found.row(static_cast<Eigen::Index>(i)).isZero());
      continue;
    }
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(33);
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double distance = (points[j] - points[i]).norm();
      if (j != i && distance < options.radius_m) {
        sum += spfh[j] / (distance * distance);
      }
    }
    for (int h = 0; h < 3; ++h) {
      sum.segment(11 * h, 11) *= 100.0 / sum.segment(11 * h, 11).sum();
    }
    const Eigen::VectorXd row = found.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
    ++compared;
    same += (row - sum).norm() < 0.5 ? 1U : 0U;
  }
  // Points of a lonely cluster share one normal up to rounding, and with it the choice of the Darboux frame is open.
  EXPECT_GE(same, compared * 97 / 100);
  EXPECT_GT(compared, 200U);
}

TEST(Fpfh, DoesNotChangeWithTheFrame) {
  auto points = rough_yard(1500, 2);
  auto normals = estimate_normals(points, {}).vectors;
  const search::DescriptorMatrix before = fpfh(points, normals, {});
  const Pose T = pose_from_yaw(2.2, {5, -3, 1});
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = (T * points[i].cast<double>()).cast<float>();
    normals[i] = (T.linear() * normals[i].cast<double>()).cast<float>();
  }
  const search::DescriptorMatrix after = fpfh(points, normals, {});
  std::size_t same = 0;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    same += before.row(i).normalized().dot(after.row(i).normalized()) > 0.999F ? 1U : 0U;
  }
  EXPECT_GT(same, points.size() * 99 / 100);
}

TEST(Fpfh, WantedRowsAreThoseOfAllPoints) {
  const auto points = rough_yard(900, 3);
  const auto normals = estimate_normals(points, {}).vectors;
  const search::DescriptorMatrix all = fpfh(points, normals, {});
  const std::vector<std::size_t> wanted{500, 3, 899, 42};
  const search::DescriptorMatrix some = fpfh(points, normals, {}, wanted);
  ASSERT_EQ(some.rows(), 4);
  for (std::size_t r = 0; r < wanted.size(); ++r) {
    EXPECT_EQ(some.row(static_cast<Eigen::Index>(r)), all.row(static_cast<Eigen::Index>(wanted[r])));
  }
}

TEST(Fpfh, PointsWithoutNormalHaveNoPart) {
  auto points = rough_yard(600, 4);
  auto normals = estimate_normals(points, {}).vectors;
  const search::DescriptorMatrix before = fpfh(points, normals, {});
  points.push_back(points[10] + Eigen::Vector3f(0.01F, 0, 0));
  normals.push_back(Eigen::Vector3f::Zero());
  const search::DescriptorMatrix after = fpfh(points, normals, {});
  EXPECT_TRUE(after.row(600).isZero());
  EXPECT_EQ(after.topRows(600), before);
}

TEST(Fpfh, SameBytesAtAnyNumberOfThreads) {
  const auto points = rough_yard(2000, 5);
  const auto normals = estimate_normals(points, {}).vectors;
  set_thread_count(1);
  const search::DescriptorMatrix one = fpfh(points, normals, {});
  set_thread_count(4);
  const search::DescriptorMatrix four = fpfh(points, normals, {});
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(Fpfh, RefusesWhatDoesNotFit) {
  EXPECT_THROW(fpfh({{1, 2, 3}}, {}, {}), std::invalid_argument);
  EXPECT_EQ(fpfh({}, {}, {}).rows(), 0);
}

}  // namespace
}  // namespace loopmark::features

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/voxel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "loopmark/cloud/overlap.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::cloud {
namespace {

std::vector<Eigen::Vector3f> random_points(std::size_t count, double extent, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(rng.uniform(-extent, extent), rng.uniform(-extent, extent), rng.uniform(-2, 2));
  }
  return points;
}

TEST(Voxel, TheCentralPointIsTheNearestToTheCentreInWhateverOrderTheyCome) {
  auto points = random_points(5000, 10, 2);
  const auto squared = [](const Eigen::Vector3f& p) {
    const Eigen::Array3f cell = (p * static_cast<float>(1.0 / 0.7)).array().floor();
    return ((p * static_cast<float>(1.0 / 0.7)).array() - cell - 0.5F).matrix().squaredNorm();
  };
  std::map<std::tuple<int, int, int>, float> least;
  const auto cell_of = [](const Eigen::Vector3f& p) {
    const Eigen::Array3f cell = (p * static_cast<float>(1.0 / 0.7)).array().floor();
    return std::make_tuple(static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z()));
  };
  for (const Eigen::Vector3f& p : points) {
    const auto found = least.emplace(cell_of(p), squared(p)).first;
    found->second = std::min(found->second, squared(p));
  }
  for (int order = 0; order < 2; ++order) {
    const auto indices = voxel_central_indices(points, 0.7);
    EXPECT_EQ(indices.size(), least.size());
    for (const std::size_t i : indices) {
      EXPECT_NEAR(squared(points[i]), least.at(cell_of(points[i])), 1e-5F);
    }
    std::reverse(points.begin(), points.end());
  }
}

TEST(Voxel, AgreesWithAnOrderedMap) {
  const auto points = random_points(5000, 10, 1);
  std::map<std::tuple<int, int, int>, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f cell = (points[i] * static_cast<float>(1.0 / 0.7)).array().floor();
    cells[{static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())}].push_back(i);
  }
  std::vector<bool> first(points.size(), false);
  for (const auto& [cell, members] : cells) {
    first[members.front()] = true;
  }
  const auto indices = voxel_first_indices(points, 0.7);
  EXPECT_EQ(indices.size(), cells.size());
  for (const std::size_t i : indices) {
    EXPECT_TRUE(first[i]);
  }
  EXPECT_EQ(voxel_centroids(points, 0.7).size(), cells.size());
}

TEST(Voxel, CentroidIsTheMean) {
  const auto centroids = voxel_centroids({{0.1F, 0.1F, 0.1F}, {0.3F, 0.5F, 0.7F}, {5.0F, 0.0F, 0.0F}}, 1.0);
  ASSERT_EQ(centroids.size(), 2U);
  EXPECT_LT((centroids[0] - Eigen::Vector3f(0.2F, 0.3F, 0.4F)).norm(), 1e-6F);
}

TEST(Voxel, RefusesASizeOfZero) { EXPECT_THROW(voxel_first_indices({}, 0.0), InputError); }

TEST(Overlap, OneForItselfAndNothingFarAway) {
  PointCloud cloud;
  cloud.points = random_points(3000, 20, 2);
  EXPECT_DOUBLE_EQ(overlap(cloud, cloud, Pose::Identity()).symmetric, 1.0);
  EXPECT_DOUBLE_EQ(overlap(cloud, cloud, pose_from_yaw(0.0, {100, 0, 0})).symmetric, 0.0);
}

TEST(Overlap, HalfMovedAwayIsAboutAHalf) {
  PointCloud cloud;
  cloud.points = random_points(20000, 20, 3);
  const Pose T = pose_from_yaw(0.0, {20, 0, 0});
  const Overlap exact = overlap(cloud, cloud, T);
  EXPECT_NEAR(exact.source, 0.5, 0.05);
  EXPECT_NEAR(overlap(OverlapCloud(cloud.points), OverlapCloud(cloud.points), T).source, exact.source, 0.02);
}

TEST(Overlap, SymmetricIsTheSmallerShare) {
  PointCloud wide;
  PointCloud narrow;
  wide.points = random_points(20000, 20, 4);
  narrow.points = random_points(5000, 10, 5);
  const Overlap result = overlap(narrow, wide, Pose::Identity());
  EXPECT_DOUBLE_EQ(result.source, 1.0);
  EXPECT_LT(result.symmetric, 0.35);
}

}  // namespace
}  // namespace loopmark::cloud

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Oracle: all points in one cloud, thinned by voxel_first_indices.
#include "loopmark/cloud/thin_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <tuple>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::cloud {
namespace {

namespace fs = std::filesystem;
using Row = std::tuple<float, float, float, float>;

constexpr double kVoxel_m = 0.2;

/// Clouds along a path of 400 m that comes back to its start.
std::vector<PointCloud> drive() {
  Rng rng(5);
  std::vector<PointCloud> clouds;
  for (int i = 0; i < 80; ++i) {
    const double x = i < 40 ? 10.0 * i : 10.0 * (79 - i);
    PointCloud& cloud = clouds.emplace_back();
    for (int k = 0; k < 2000; ++k) {
      cloud.points.emplace_back(static_cast<float>(x + rng.uniform(-30, 30)), static_cast<float>(rng.uniform(-30, 30)),
                                static_cast<float>(rng.uniform(-1, 1)));
      cloud.intensity.push_back(static_cast<float>(rng.uniform(0, 1)));
    }
  }
  return clouds;
}

std::vector<Row> rows(const PointCloud& cloud) {
  std::vector<Row> result;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    result.emplace_back(p.x(), p.y(), p.z(), cloud.intensity.empty() ? -1.0F : cloud.intensity[i]);
  }
  return result;
}

/// A file of this test alone: tests run side by side.
fs::path scratch() {
  return fs::path(testing::TempDir()) /
         (std::string("loopmark_thin_cloud_test_") + testing::UnitTest::GetInstance()->current_test_info()->name());
}

std::vector<Row> tiled(const std::vector<PointCloud>& clouds, std::size_t in_memory) {
  TiledCloud tiles(kVoxel_m, scratch(), in_memory);
  for (const PointCloud& cloud : clouds) {
    tiles.add(cloud);
  }
  std::vector<Row> result;
  tiles.for_each_tile([&](const PointCloud& tile) {
    const std::vector<Row> more = rows(tile);
    result.insert(result.end(), more.begin(), more.end());
  });
  EXPECT_EQ(result.size(), tiles.size());
  return result;
}

TEST(TiledCloud, HoldsTheFirstPointOfEachVoxelInTheSameOrderAtAnyMemory) {
  const std::vector<PointCloud> clouds = drive();
  PointCloud all;
  for (const PointCloud& cloud : clouds) {
    append(all, cloud);
  }
  std::vector<Row> expected = rows(voxel_downsampled(all, kVoxel_m));
  std::vector<Row> found = tiled(clouds, 1'000'000);
  EXPECT_EQ(found, tiled(clouds, 20'000)) << "with tiles on the disk";
  EXPECT_EQ(found, tiled(clouds, 1));
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
  EXPECT_FALSE(fs::exists(scratch()));
}

TEST(TiledCloud, IntensityStaysOnlyWhereAllHaveIt) {
  std::vector<PointCloud> clouds = drive();
  clouds.back().intensity.clear();
  for (const Row& row : tiled(clouds, 1000)) {
    ASSERT_EQ(std::get<3>(row), -1.0F);
  }
}

TEST(OverviewCloud, GrowsItsVoxelsInsteadOfItself) {
  OverviewCloud few(kVoxel_m, 1'000'000);
  OverviewCloud many(kVoxel_m, 5000);
  PointCloud all;
  for (const PointCloud& cloud : drive()) {
    few.add(cloud.points);
    many.add(cloud.points);
    append(all, cloud);
  }
  EXPECT_EQ(few.points(), voxel_downsampled(all, kVoxel_m).points);
  EXPECT_EQ(few.voxel_m(), kVoxel_m);
  EXPECT_LE(many.points().size(), 5000U);
  EXPECT_GT(many.points().size(), 500U);
  EXPECT_GT(many.voxel_m(), kVoxel_m);
  EXPECT_EQ(voxel_first_indices(many.points(), many.voxel_m()).size(), many.points().size());
}

}  // namespace
}  // namespace loopmark::cloud

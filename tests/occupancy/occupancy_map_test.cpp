// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/occupancy/occupancy_map.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>
#include <sstream>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/storage/files.hpp"
#include "street.hpp"

namespace loopmark::occupancy {
namespace {

using namespace testing;

class OccupancyMap : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  OccupancyStatistics build(const std::vector<StreetScan>& scans, const OccupancyOptions& options = {}) const {
    OccupancyMapBuilder builder(options, folder_);
    for (const StreetScan& scan : scans) {
      builder.insert(scan.points, scan.T_map_sensor);
    }
    return builder.write(bt_, ot_);
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("loopmark_occupancy_" + std::to_string(::getpid()));
  std::filesystem::path bt_ = folder_ / "map.bt";
  std::filesystem::path ot_ = folder_ / "map.ot";
};

std::string full_bytes(octomap::OcTree& tree) {
  std::ostringstream out;
  tree.prune();
  tree.write(out);
  return out.str();
}

std::string binary_bytes(octomap::OcTree& tree) {
  std::ostringstream out;
  tree.writeBinary(out);  // makes the tree its maximum-likelihood form
  return out.str();
}

TEST_F(OccupancyMap, IsByteForByteWhatOctomapWrites) {
  for (const double max_range : {20.0, 50.0}) {
    const std::vector<StreetScan> scans = street(6, 8000);
    OccupancyOptions options;
    options.max_range_m = max_range;
    octomap::OcTree oracle(options.resolution_m);
    for (const StreetScan& scan : scans) {
      insert_with_octomap(oracle, scan, max_range);
    }
    const OccupancyStatistics statistics = build(scans, options);
    EXPECT_EQ(storage::read_file(ot_), full_bytes(oracle));
    EXPECT_EQ(statistics.nodes, oracle.size());
    EXPECT_EQ(storage::read_file(bt_), binary_bytes(oracle));
  }
}

TEST_F(OccupancyMap, OpensInOctomap) {
  build(street(2, 3000));
  const std::unique_ptr<octomap::AbstractOcTree> full(octomap::AbstractOcTree::read(ot_.string()));
  ASSERT_NE(full, nullptr);
  octomap::OcTree binary(bt_.string());
  EXPECT_GT(binary.getNumLeafNodes(), 1000U);
  std::size_t on_the_wall = 0;
  for (auto leaf = binary.begin_leafs(); leaf != binary.end_leafs(); ++leaf) {
    on_the_wall += binary.isNodeOccupied(*leaf) && std::abs(leaf.getY() - 8.0) < 0.2 ? 1 : 0;
  }
  EXPECT_GT(on_the_wall, 100U);
  const octomap::OcTreeNode* air = binary.search(-9.0 + 0.1, 2.0, 1.8);
  ASSERT_NE(air, nullptr);
  EXPECT_FALSE(binary.isNodeOccupied(air));
}

TEST_F(OccupancyMap, WhatMovesAwayThinsOut) {
  StreetScan scan;
  scan.points = {{10.0F, 0.05F, 0.05F}};
  OccupancyMapBuilder builder({}, folder_);
  builder.insert(scan.points, scan.T_map_sensor);
  scan.points = {{12.0F, 0.06F, 0.06F}};
  for (int i = 0; i < 3; ++i) {
    builder.insert(scan.points, scan.T_map_sensor);
  }
  builder.write(bt_, {});
  octomap::OcTree tree(bt_.string());
  EXPECT_FALSE(tree.isNodeOccupied(tree.search(10.0, 0.05, 0.05)));
  EXPECT_TRUE(tree.isNodeOccupied(tree.search(12.0, 0.06, 0.06)));
}

TEST_F(OccupancyMap, IsTheSameWithLittleMemoryAndAnyNumberOfThreads) {
  const std::vector<StreetScan> scans = street(12, 2000);
  set_thread_count(1);
  EXPECT_EQ(build(scans).spilled_tiles, 0U);
  const std::string full = storage::read_file(ot_);
  const std::string binary = storage::read_file(bt_);
  OccupancyOptions tight;
  tight.memory_mb = 1;
  set_thread_count(2);
  EXPECT_GT(build(scans, tight).spilled_tiles, 10U);
  set_thread_count(0);
  EXPECT_EQ(storage::read_file(ot_), full);
  EXPECT_EQ(storage::read_file(bt_), binary);
}

TEST_F(OccupancyMap, LeavesNothingBehindButItsFiles) {
  build(street(1, 500));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) {
    ++files;
  }
  EXPECT_EQ(files, 2U);
}

TEST_F(OccupancyMap, OfNothingIsAnEmptyTree) {
  EXPECT_EQ(build({}).nodes, 0U);
  octomap::OcTree oracle(0.2);
  EXPECT_EQ(storage::read_file(ot_), full_bytes(oracle));
  EXPECT_EQ(storage::read_file(bt_), binary_bytes(oracle));
}

TEST_F(OccupancyMap, SkipsAndCountsPointsThatMakeNoSense) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  StreetScan scan;
  scan.points = {{nan, 0, 0}, {1, 2, std::numeric_limits<float>::infinity()}, {5, 5, 0}, {0, 0, 0}, {1e30F, 0, 0}};
  const OccupancyStatistics statistics = build({scan});
  EXPECT_EQ(statistics.rays + statistics.skipped_points, 5U);
  EXPECT_GE(statistics.skipped_points, 2U);
}

TEST_F(OccupancyMap, NamesWhatMakesNoSense) {
  OccupancyOptions options;
  options.resolution_m = 0.0;
  EXPECT_THROW(OccupancyMapBuilder(options, folder_), InputError);
  options = {};
  options.max_range_m = 1000.0;
  EXPECT_THROW(OccupancyMapBuilder(options, folder_), InputError);
  EXPECT_THROW(OccupancyMapBuilder({}, folder_ / "missing"), InputError);
  OccupancyMapBuilder builder({}, folder_);
  EXPECT_THROW(builder.insert({{1, 1, 1}}, pose_from_yaw(0.0, {7000.0, 0, 0})), InputError);
  EXPECT_THROW(builder.write("/proc/map.bt", {}), InputError);
}

}  // namespace
}  // namespace loopmark::occupancy

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/mapper.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "loopmark/core/error.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/storage/files.hpp"
#include "support/box_world.hpp"

namespace loopmark::mapping {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kScans = 9;

/// A drive at 10 m/s along a street from the first scan on; it steers all the time.
class MapperTest : public testing::Test {
 protected:
  ~MapperTest() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }

  Scan scan(std::size_t i) const {
    return {i, 0.1 * static_cast<double>(i), testing_support::sweep(world_, pose(i), velocity_, 0.01, i)};
  }
  Pose pose(std::size_t i) const {
    return pose_from_yaw(-0.05, {0.0, 0.0, 1.8}) * exp_se3(0.1 * static_cast<double>(i) * velocity_);
  }
  Mapper mapper_on(const map_store::RunFolder& folder) const {
    return {folder, {}, nullptr, odometry::Compensation::kRawGivenTimes, {}};
  }
  fs::path new_folder(const std::string& name) const {
    fs::create_directories(root_);
    return root_ / name;
  }

  /// All that a map is made from: what was written of scans and keyframes.
  std::string written(const map_store::RunFolder& folder, std::size_t keyframes) const {
    std::string bytes = storage::read_file(folder.scan_records());
    for (std::size_t k = 0; k < keyframes; ++k) {
      bytes += storage::read_file(folder.keyframe(k, "pcd")) + storage::read_file(folder.keyframe(k, "place"));
    }
    return bytes;
  }

  testing_support::BoxWorld world_ = testing_support::street(120.0, 5);
  Vector6d velocity_ = (Vector6d() << 10.0, 0.0, 0.0, 0.0, 0.0, 0.3).finished();
  fs::path root_ = fs::path(testing::TempDir()) / ("loopmark_mapper_" + std::to_string(::getpid()));
};

TEST_F(MapperTest, TheFirstKeyframeOfASegmentIsNotBentByTheMotion) {
  const map_store::RunFolder folder = map_store::RunFolder::create(new_folder("first"));
  Mapper mapper = mapper_on(folder);
  for (std::size_t i = 0; i < 3; ++i) {
    mapper.add(scan(i));
  }
  std::vector<double> off;  // along the beam, from what a sensor that stands still would see
  for (const Eigen::Vector3f& point : io::read_point_file(folder.keyframe(0, "pcd")).cloud.points) {
    const Eigen::Vector3d ray = pose(0).linear() * point.cast<double>().normalized();
    off.push_back(std::abs(world_.range(pose(0).translation(), ray) - static_cast<double>(point.norm())));
  }
  ASSERT_GT(off.size(), 500U);
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() * 3 / 4], 0.1);  // bent, it is 0.2 m
  EXPECT_NEAR(mapper.scans().front().velocity[0], 10.0, 0.5);
}

TEST_F(MapperTest, GoesOnFromAnySavedStateAsIfNeverInterrupted) {
  const map_store::RunFolder whole = map_store::RunFolder::create(new_folder("whole"));
  std::size_t keyframes = 0;
  {
    Mapper mapper = mapper_on(whole);
    for (std::size_t i = 0; i < kScans; ++i) {
      mapper.add(scan(i));
    }
    mapper.end_log();
    keyframes = mapper.keyframes().size();
  }
  const std::string expected = written(whole, keyframes);
  for (std::size_t stop = 1; stop < kScans; ++stop) {
    const map_store::RunFolder folder = map_store::RunFolder::create(new_folder("stop" + std::to_string(stop)));
    {
      Mapper mapper = mapper_on(folder);
      for (std::size_t i = 0; i < stop; ++i) {
        mapper.add(scan(i));
      }
      mapper.checkpoint();
    }
    Mapper mapper = mapper_on(folder);
    ASSERT_EQ(mapper.scans().size(), stop);
    for (std::size_t i = stop; i < kScans; ++i) {
      mapper.add(scan(i));
    }
    mapper.end_log();
    EXPECT_TRUE(written(folder, keyframes) == expected) << "stopped after " << stop;
  }
}

TEST_F(MapperTest, SaysSoWhenTheSavedStateIsDamaged) {
  const map_store::RunFolder folder = map_store::RunFolder::create(new_folder("damaged"));
  {
    Mapper mapper = mapper_on(folder);
    mapper.add(scan(0));  // a keyframe that waits for the next scan, so the state holds its cloud
    mapper.checkpoint();
  }
  const fs::path file = folder / "records/odometry.state";
  const std::string bytes = storage::read_file(file);
  for (const std::size_t place : {bytes.size() / 3, bytes.size() - 100}) {
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    storage::write_file_atomically(file, damaged);
    EXPECT_THROW(mapper_on(folder), InputError) << "byte " << place;
  }
  storage::write_file_atomically(file, std::string_view(bytes).substr(0, bytes.size() / 4));
  EXPECT_THROW(mapper_on(folder), InputError);
}

}  // namespace
}  // namespace loopmark::mapping

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/point_files.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "io/io_fixtures.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::io {
namespace {

namespace fs = std::filesystem;

using testing::bytes_of;
using ::testing::HasSubstr;
using testing::message_of;
using testing::random_cloud;
using testing::TemporaryFolder;

void expect_equal(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.ring, b.ring);
  EXPECT_EQ(a.time_offset_s, b.time_offset_s);
}

TEST(PointFiles, PcdComesBackAsWritten) {
  const TemporaryFolder folder;
  const PointCloud cloud = random_cloud(500);
  write_pcd(folder / "a.pcd", cloud);
  expect_equal(read_point_file(folder / "a.pcd").cloud, cloud);
}

TEST(PointFiles, PlyComesBackAsWrittenWithAndWithoutColour) {
  const TemporaryFolder folder;
  const PointCloud cloud = random_cloud(500);
  write_ply(folder / "plain.ply", cloud);
  write_ply(folder / "colour.ply", cloud, std::vector<Rgb>(cloud.size(), Rgb{1, 2, 3}));
  expect_equal(read_point_file(folder / "plain.ply").cloud, cloud);
  expect_equal(read_point_file(folder / "colour.ply").cloud, cloud);
}

TEST(PointFiles, PlyInPartsIsThePlyOfTheWhole) {
  const TemporaryFolder folder;
  const PointCloud cloud = random_cloud(500);
  write_ply(folder / "whole.ply", cloud, std::vector<Rgb>(cloud.size(), Rgb{1, 2, 3}));
  const auto add_in_parts = [&](const PlyPart& add) {
    for (std::size_t begin = 0; begin < cloud.size(); begin += 125) {
      std::vector<std::size_t> indices(125);
      std::iota(indices.begin(), indices.end(), begin);
      add(select(cloud, indices), std::vector<Rgb>(125, Rgb{1, 2, 3}));
    }
  };
  write_ply_in_parts(folder / "parts.ply", 500, add_in_parts);
  EXPECT_EQ(storage::read_file(folder / "parts.ply"), storage::read_file(folder / "whole.ply"));
  EXPECT_THROW(write_ply_in_parts(folder / "wrong.ply", 499, add_in_parts), std::logic_error);
  EXPECT_FALSE(fs::exists(folder / "wrong.ply"));
  write_ply_in_parts(folder / "none.ply", 0, [](const PlyPart&) {});
  EXPECT_THAT(storage::read_file(folder / "none.ply"), HasSubstr("element vertex 0\n"));
}

TEST(PointFiles, BinKeepsPointsAndIntensity) {
  const TemporaryFolder folder;
  PointCloud cloud = random_cloud(500);
  write_bin(folder / "a.bin", cloud);
  cloud.ring.clear();
  cloud.time_offset_s.clear();
  expect_equal(read_point_file(folder / "a.bin").cloud, cloud);
}

TEST(PointFiles, NuScenesBinHasFiveColumns) {
  const TemporaryFolder folder;
  std::string bytes;
  for (int i = 1; i <= 60; ++i) {
    for (const float value : {static_cast<float>(i), 2.0F, 3.0F, 7.0F, static_cast<float>(i % 32)}) {
      bytes += bytes_of(value);
    }
  }
  folder.write("a.pcd.bin", bytes);
  const PointCloud cloud = read_point_file(folder / "a.pcd.bin").cloud;
  ASSERT_EQ(cloud.size(), 60U);
  EXPECT_EQ(cloud.points[4], Eigen::Vector3f(5, 2, 3));
  EXPECT_EQ(cloud.intensity[4], 7.0F);
  EXPECT_EQ(cloud.ring[4], 5);
}

TEST(PointFiles, AsciiPcdWithOddFieldsAndAbsoluteTimes) {
  const TemporaryFolder folder;
  std::string text =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS timestamp normal x y z _ ring\nSIZE 8 4 8 8 8 1 2\nTYPE F F F F F U U\n"
      "COUNT 1 3 1 1 1 2 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n";
  text += "1600000000.25 0 0 1 1 2 3 0 0 9\n1600000000.20 0 0 1 nan 2 3 0 0 8\n1600000000.30 0 0 1 4 5 6 0 0 7\n";
  folder.write("a.pcd", text);
  const PointFile file = read_point_file(folder / "a.pcd");
  ASSERT_EQ(file.cloud.size(), 2U);
  EXPECT_EQ(file.dropped.not_finite, 1U);
  EXPECT_EQ(file.cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(file.cloud.ring[1], 7);
  ASSERT_TRUE(file.first_time_s.has_value());
  EXPECT_NEAR(*file.first_time_s, 1600000000.25, 1e-6);
  EXPECT_NEAR(file.cloud.time_offset_s[1], 0.05, 1e-6);
}

TEST(PointFiles, RelativeTimesInNanosecondsBecomeSeconds) {
  const TemporaryFolder folder;
  std::string bytes =
      "VERSION 0.7\nFIELDS x y z t\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 100\nHEIGHT 1\n"
      "POINTS 100\nDATA binary\n";
  for (std::uint32_t i = 0; i < 100; ++i) {
    bytes += bytes_of(1.0F) + bytes_of(2.0F) + bytes_of(3.0F) + bytes_of(i * 1'000'000U);
  }
  folder.write("a.pcd", bytes);
  const PointFile file = read_point_file(folder / "a.pcd");
  EXPECT_FALSE(file.first_time_s.has_value());
  EXPECT_NEAR(file.cloud.time_offset_s[99], 0.099, 1e-6);
}

TEST(PointFiles, AsciiPly) {
  const TemporaryFolder folder;
  folder.write("a.ply",
               "ply\nformat ascii 1.0\ncomment x\nelement vertex 2\nproperty double x\nproperty float y\n"
               "property float z\nproperty uchar intensity\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n1 2 3 9\n4 5 6 8\n3 0 1 1\n");
  const PointCloud cloud = read_point_file(folder / "a.ply").cloud;
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(cloud.intensity[1], 8.0F);
}

TEST(PointFiles, SenselessPointsAreLeftOutAndCounted) {
  const TemporaryFolder folder;
  PointCloud cloud = random_cloud(100);
  cloud.points[3].x() = std::numeric_limits<float>::quiet_NaN();
  cloud.points[4].z() = std::numeric_limits<float>::infinity();
  cloud.points[5].y() = 1e30F;
  cloud.points[6].setZero();
  write_pcd(folder / "a.pcd", cloud);
  const PointFile file = read_point_file(folder / "a.pcd");
  EXPECT_EQ(file.cloud.size(), 96U);
  EXPECT_EQ(file.cloud.intensity.size(), 96U);
  EXPECT_EQ(file.cloud.intensity[3], cloud.intensity[7]);
  EXPECT_EQ(file.dropped.not_finite, 2U);
  EXPECT_EQ(file.dropped.absurd, 1U);
  EXPECT_EQ(file.dropped.no_return, 1U);
}

TEST(PointFiles, DamageNamesTheFileThePlaceAndTheProblem) {
  const TemporaryFolder folder;
  write_pcd(folder / "whole.pcd", random_cloud(100));
  write_ply(folder / "whole.ply", random_cloud(100));
  const std::string pcd = storage::read_file(folder / "whole.pcd");
  const std::string ply = storage::read_file(folder / "whole.ply");
  folder.write("empty.bin", "");
  folder.write("cut.bin", std::string(100, 'x'));
  folder.write("cut.pcd", pcd.substr(0, pcd.size() - 5));
  folder.write("cut_header.pcd", pcd.substr(0, 60));
  folder.write("cut.ply", ply.substr(0, ply.size() - 5));
  folder.write("big.ply", "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nend_header\n....");
  folder.write("words.pcd",
               "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nPOINTS 1\nDATA ascii\n1 b 3\n");
  const auto problem = [&](const char* name) {
    return message_of<DamagedScan>([&] { read_point_file(folder / name); });
  };
  EXPECT_THAT(problem("missing.bin"), HasSubstr("missing.bin"));
  EXPECT_THAT(problem("empty.bin"), HasSubstr("empty"));
  EXPECT_THAT(problem("cut.bin"), HasSubstr("byte 96"));
  EXPECT_THAT(problem("cut.pcd"), HasSubstr("truncated"));
  EXPECT_THAT(problem("cut_header.pcd"), HasSubstr("DATA"));
  EXPECT_THAT(problem("cut.ply"), HasSubstr("truncated"));
  EXPECT_THAT(problem("big.ply"), HasSubstr("binary_big_endian"));
  EXPECT_THAT(problem("words.pcd"), HasSubstr("line 8"));
}

TEST(PointFiles, TruncatedAnywhereIsNeverACrash) {
  const TemporaryFolder folder;
  write_pcd(folder / "whole.pcd", random_cloud(60));
  const std::string bytes = storage::read_file(folder / "whole.pcd");
  for (std::size_t size = 1; size < bytes.size(); size += 7) {
    folder.write("cut.pcd", bytes.substr(0, size));
    EXPECT_THROW(read_point_file(folder / "cut.pcd"), DamagedScan) << size;
  }
}

TEST(PointFiles, ReadsCompressedPcdOfARealSensor) {
  const fs::path folder = fs::path(LOOPMARK_SHARED_DIR) / "logs/reader_samples/opencalib_lidar2imu/top_center_lidar";
  if (!fs::exists(folder)) {
    GTEST_SKIP() << folder << " is not there";
  }
  const PointFile file = read_point_file(folder / "2021-10-26-16-21-29-468.pcd");
  EXPECT_EQ(file.cloud.size() + file.dropped.not_finite + file.dropped.no_return + file.dropped.absurd, 80787U);
  ASSERT_TRUE(file.first_time_s.has_value());
  EXPECT_NEAR(*file.first_time_s, 1635236489.369082, 1e-5);
  EXPECT_NEAR(*std::max_element(file.cloud.time_offset_s.begin(), file.cloud.time_offset_s.end()), 0.099895, 1e-5);
  EXPECT_LT(*std::max_element(file.cloud.ring.begin(), file.cloud.ring.end()), 128);
}

}  // namespace
}  // namespace loopmark::io

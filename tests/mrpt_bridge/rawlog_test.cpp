// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mrpt_bridge/rawlog.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <zlib.h>

#include <algorithm>

#include "io/io_fixtures.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::mrpt_bridge {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::message_of;
using testing::random_cloud;
using testing::TemporaryFolder;

fs::path write_log(const fs::path& path, std::size_t scans) {
  RawlogWriter writer(path, "top");
  for (std::size_t i = 0; i < scans; ++i) {
    writer.add({i, 100.0 + 0.1 * static_cast<double>(i), random_cloud(60 + i, i)},
               pose_from_yaw(0.0, {static_cast<double>(i), 0, 0}));
  }
  writer.finish();
  return path;
}

TEST(Rawlog, ComesBackAsWrittenInAnyOrder) {
  const TemporaryFolder folder;
  const RawlogReader reader(write_log(folder / "a.rawlog", 30), "");
  ASSERT_EQ(reader.size(), 30U);
  EXPECT_EQ(reader.sensor_label(), "top");
  EXPECT_EQ(reader.problem(), "");
  EXPECT_NEAR(reader.stamp_s(7), 100.7, 1e-6);
  EXPECT_NEAR(reader.truth().poses.at(7).translation().x(), 7.0, 1e-12);
  for (const std::size_t i : {0UL, 1UL, 29UL, 3UL, 5UL, 4UL, 28UL}) {
    EXPECT_EQ(reader.read(i).points, random_cloud(60 + i, i).points) << i;
  }
  parallel_for(reader.size(), [&](std::size_t i) { EXPECT_EQ(reader.read(i).size(), 60 + i); });
}

TEST(Rawlog, OnlyTheSensorAskedFor) {
  const TemporaryFolder folder;
  write_log(folder / "a.rawlog", 3);
  EXPECT_THAT(message_of<InputError>([&] { RawlogReader(folder / "a.rawlog", "rear"); }), HasSubstr("'rear'"));
  EXPECT_EQ(RawlogReader(folder / "a.rawlog", "top").size(), 3U);
}

TEST(Rawlog, DamageIsSaidAndWhatCameBeforeIsKept) {
  const TemporaryFolder folder;
  write_log(folder / "whole.rawlog", 30);
  const std::string bytes = storage::read_file(folder / "whole.rawlog");
  folder.write("cut.rawlog", bytes.substr(0, bytes.size() / 2));
  folder.write("garbage.rawlog", "this is no rawlog at all");
  folder.write("empty.rawlog", "");
  const RawlogReader cut(folder / "cut.rawlog", "");
  EXPECT_GT(cut.size(), 5U);
  EXPECT_LT(cut.size(), 30U);
  EXPECT_THAT(cut.problem(), HasSubstr("truncated"));
  EXPECT_EQ(cut.read(5).size(), 65U);
  EXPECT_THAT(message_of<InputError>([&] { RawlogReader(folder / "garbage.rawlog", ""); }), HasSubstr("not a rawlog"));
  EXPECT_THROW(RawlogReader(folder / "empty.rawlog", ""), InputError);
  EXPECT_THROW(RawlogReader(folder / "missing.rawlog", ""), InputError);
}

TEST(Rawlog, UnfinishedFilesDoNotGetTheName) {
  const TemporaryFolder folder;
  {
    RawlogWriter writer(folder / "a.rawlog", "top");
    writer.add({0, 0.0, random_cloud(60)});
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_THROW(RawlogWriter(folder / "no/such/folder/a.rawlog", "top"), InputError);
}

std::string unpacked(const fs::path& path) {
  const gzFile file = ::gzopen(path.c_str(), "rb");
  std::string bytes(1U << 24U, '\0');
  bytes.resize(static_cast<std::size_t>(::gzread(file, bytes.data(), static_cast<unsigned>(bytes.size()))));
  ::gzclose(file);
  return bytes;
}

TEST(Rawlog, ALengthThatIsALieTakesNoMemoryAndEndsTheLogThere) {
  const TemporaryFolder folder;
  const std::string bytes = unpacked(write_log(folder / "whole.rawlog", 10));
  const std::string count = testing::bytes_of(std::uint32_t{65});  // of the sixth scan's points
  std::size_t changed = 0;
  for (std::size_t at = bytes.find(count); at != std::string::npos; at = bytes.find(count, at + 1)) {
    for (const std::uint32_t claim : {0x20000000U, 0x40000000U, 0xffffffffU}) {
      std::string evil = bytes;
      evil.replace(at, 4, testing::bytes_of(claim));
      folder.write("evil.rawlog", evil);
      const RawlogReader reader(folder / "evil.rawlog", "");
      EXPECT_LE(reader.size(), 10U);
      changed += reader.size() == 5 && !reader.problem().empty() ? 1 : 0;
    }
  }
  EXPECT_GE(changed, 3U);
  struct rusage usage {};
  ASSERT_EQ(::getrusage(RUSAGE_CHILDREN, &usage), 0);
  EXPECT_LT(usage.ru_maxrss, 3'000'000);  // kB
}

TEST(Rawlog, FullDiskIsAnError) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full";
  }
  const TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder / "a.rawlog.partial");
  RawlogWriter writer(folder / "a.rawlog", "top");
  EXPECT_THROW(
      {
        for (std::size_t i = 0; i < 2000; ++i) {
          writer.add({i, 0.0, random_cloud(1000, i)});
        }
        writer.finish();
      },
      InputError);
}

TEST(Rawlog, ReadsRealVelodynePackets) {
  const fs::path folder = fs::path(LOOPMARK_SHARED_DIR) / "logs/reader_samples/mrpt";
  if (!fs::exists(folder)) {
    GTEST_SKIP() << folder << " is not there";
  }
  const RawlogReader reader(folder / "test_velodyne_VLP16.rawlog", "");
  ASSERT_GT(reader.size(), 0U);
  const PointCloud cloud = reader.read(0);
  EXPECT_GT(cloud.size(), 5000U);
  ASSERT_EQ(cloud.ring.size(), cloud.size());
  EXPECT_EQ(*std::max_element(cloud.ring.begin(), cloud.ring.end()), 15);
  ASSERT_EQ(cloud.time_offset_s.size(), cloud.size());
  EXPECT_LT(*std::max_element(cloud.time_offset_s.begin(), cloud.time_offset_s.end()), 0.3F);
  EXPECT_GT(*std::max_element(cloud.time_offset_s.begin(), cloud.time_offset_s.end()), 0.03F);
  EXPECT_THAT(message_of<InputError>([&] { RawlogReader(folder / "rot_scan_velodyne.rawlog", ""); }),
              HasSubstr("elevation"));
}

}  // namespace
}  // namespace loopmark::mrpt_bridge

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/drive_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/storage/files.hpp"
#include "small_town.hpp"

namespace loopmark::simulation {
namespace {

namespace fs = std::filesystem;

class DriveWriter : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("loopmark_simulation_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static Drive short_drive() {
    DriveOptions o;
    o.length_m = 12.0;
    o.sensor = "vlp16";
    o.halt_every_m = 0.0;
    return {small_town(), o};
  }

  static std::map<std::string, std::string> hashes(const fs::path& folder) {
    std::map<std::string, std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) {
        result[fs::relative(entry.path(), folder)] = storage::sha256_of_file(entry.path());
      }
    }
    return result;
  }

  fs::path folder_;
};

TEST_F(DriveWriter, WritesTheSameBytesAtAnyNumberOfThreads) {
  const Drive drive = short_drive();
  const std::size_t before = thread_count();
  set_thread_count(1);
  write_drive(small_world(), small_town(), drive, folder_ / "one", {});
  set_thread_count(2);
  write_drive(small_world(), small_town(), drive, folder_ / "two", {});
  set_thread_count(before);
  EXPECT_EQ(hashes(folder_ / "one"), hashes(folder_ / "two"));
  EXPECT_GE(hashes(folder_ / "one").size(), drive.size() + 6);
}

TEST_F(DriveWriter, LogsAreReadBackWithTheirTruth) {
  const Drive drive = short_drive();
  for (const LogFormat format : {LogFormat::kKitti, LogFormat::kPcd}) {
    const fs::path log_folder = folder_ / (format == LogFormat::kKitti ? "kitti" : "pcd");
    write_drive(small_world(), small_town(), drive, log_folder, {format, false});
    const auto log = io::open_log(log_folder);
    ASSERT_EQ(log->size(), drive.size());
    ASSERT_EQ(log->truth().size(), drive.size());
    EXPECT_NEAR(log->stamp_s(3), drive.stamp_s(3), 1e-6);
    const Pose expected = drive.pose(drive.stamp_s(0)).inverse() * drive.pose(drive.stamp_s(7));
    EXPECT_LT(pose_error(log->truth()[0].inverse() * log->truth()[7], expected).translation_m, 1e-6);
    const Scan read = log->read(2);
    const Scan made = render_scan(small_world(), drive, 2);
    ASSERT_EQ(read.cloud.size(), made.cloud.size());
    EXPECT_EQ(read.cloud.points, made.cloud.points);
    if (format == LogFormat::kPcd) {
      EXPECT_EQ(read.cloud.ring, made.cloud.ring);
      EXPECT_NEAR(read.cloud.time_offset_s[100], made.cloud.time_offset_s[100], 1e-6);
    }
  }
}

TEST_F(DriveWriter, RawlogsHoldTimesAndTruth) {
  const Drive drive = short_drive();
  write_drive(small_world(), small_town(), drive, folder_ / "mrpt", {LogFormat::kRawlog, false});
  const auto log = io::open_log(folder_ / "mrpt" / "drive.rawlog");
  ASSERT_EQ(log->size(), drive.size());
  ASSERT_EQ(log->truth().size(), drive.size());
  const Scan read = log->read(4);
  const Scan made = render_scan(small_world(), drive, 4);
  ASSERT_EQ(read.cloud.size(), made.cloud.size());
  EXPECT_LT((read.cloud.points[50] - made.cloud.points[50]).norm(), 1e-5F);
  EXPECT_NEAR(log->stamp_s(4) - log->stamp_s(0), 0.4, 1e-5);
  EXPECT_EQ(read.cloud.ring, made.cloud.ring);
  EXPECT_NEAR(read.cloud.time_offset_s[50], made.cloud.time_offset_s[50], 2e-6);
}

TEST_F(DriveWriter, NeverWritesIntoAFolderThatExists) {
  fs::create_directories(folder_ / "mine");
  EXPECT_THROW(write_drive(small_world(), small_town(), short_drive(), folder_ / "mine", {}), InputError);
  EXPECT_TRUE(fs::is_empty(folder_ / "mine"));
}

TEST_F(DriveWriter, SaysWhenTheFolderCannotBeMade) {
  storage::write_file_atomically(folder_ / "file", "x");
  EXPECT_THROW(write_drive(small_world(), small_town(), short_drive(), folder_ / "file" / "log", {}), InputError);
}

}  // namespace
}  // namespace loopmark::simulation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/drive_log.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "io/io_fixtures.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark::io {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::random_cloud;
using testing::TemporaryFolder;

std::string number_name(std::size_t i, const char* extension) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu%s", i, extension);
  return name;
}

/// A KITTI drive: velodyne/%06d.bin and times.txt.
void write_kitti_scans(const fs::path& folder, std::size_t scans) {
  fs::create_directories(folder / "velodyne");
  std::ofstream times(folder / "times.txt");
  for (std::size_t i = 0; i < scans; ++i) {
    write_bin(folder / "velodyne" / number_name(i, ".bin"), random_cloud(60 + i, i));
    times << 0.104 * static_cast<double>(i) << "\n";
  }
}

std::vector<Pose> forward_poses(std::size_t count) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(pose_from_yaw(0.1 * static_cast<double>(i), {static_cast<double>(i), 0.5, 0.0}));
  }
  return poses;
}

TEST(DriveLog, KittiOdometryTurnsCameraPosesIntoLidarPoses) {
  const TemporaryFolder folder;
  write_kitti_scans(folder.path(), 4);
  Pose T_camera_lidar = Pose::Identity();
  T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T_camera_lidar.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
  const std::vector<Pose> lidar = forward_poses(4);
  std::vector<Pose> camera;
  for (const Pose& pose : lidar) {
    camera.push_back(T_camera_lidar * pose * T_camera_lidar.inverse());
  }
  write_kitti(folder / "poses.txt", camera);
  folder.write("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: " + kitti_text({T_camera_lidar}));
  const auto log = open_log(folder.path());
  EXPECT_EQ(log->info().format, "kitti-odometry");
  EXPECT_TRUE(log->info().stamps_given);
  EXPECT_DOUBLE_EQ(log->stamp_s(2), 0.208);
  EXPECT_EQ(log->read(3).cloud.size(), 63U);
  ASSERT_EQ(log->truth().size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((log->truth()[i].matrix() - lidar[i].matrix()).norm(), 1e-6);
  }
}

TEST(DriveLog, WithoutCalibrationPosesAreThoseOfTheLidar) {
  const TemporaryFolder folder;
  write_kitti_scans(folder.path(), 3);
  write_kitti(folder / "poses.txt", forward_poses(3));
  const auto log = open_log(folder / "velodyne");
  EXPECT_LT((log->truth()[2].matrix() - forward_poses(3)[2].matrix()).norm(), 1e-6);
}

TEST(DriveLog, ScansComeInNumericOrder) {
  const TemporaryFolder folder;
  for (const char* name : {"scan_10.pcd", "scan_9.pcd", "scan_2.pcd", ".hidden.pcd"}) {
    write_pcd(folder / name, random_cloud(60));
  }
  const auto log = open_log(folder.path());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < log->size(); ++i) {
    names.push_back(fs::path(log->scan_name(i)).filename().string());
  }
  EXPECT_THAT(names, ElementsAre("scan_2.pcd", "scan_9.pcd", "scan_10.pcd"));
  EXPECT_EQ(log->info().format, "folder-pcd");
  EXPECT_FALSE(log->info().stamps_given);
  EXPECT_NEAR(log->stamp_s(2), 0.2, 1e-12);
}

TEST(DriveLog, DroppedScansKeepTheirNumbersTimesAndPoses) {
  const TemporaryFolder folder;
  write_kitti_scans(folder.path(), 6);
  write_kitti(folder / "poses.txt", forward_poses(6));
  fs::remove(folder.path() / "velodyne" / "000002.bin");
  const auto log = open_log(folder.path());
  ASSERT_EQ(log->size(), 5U);
  EXPECT_EQ(log->frame_number(2), 3U);
  EXPECT_NEAR(log->stamp_s(2), 0.312, 1e-9);
  EXPECT_NEAR(log->truth()[2].translation().x(), 3.0, 1e-6);
}

TEST(DriveLog, KittiRawHasDatesAndRebuiltTimes) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "velodyne_points" / "data");
  PointCloud cloud = random_cloud(60);
  cloud.points[0] = Eigen::Vector3f(10, 0, 0);
  cloud.points[1] = Eigen::Vector3f(0, 10, 0);
  cloud.points[2] = Eigen::Vector3f(0, -10, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    write_bin(folder.path() / "velodyne_points" / "data" / ("000000000" + std::to_string(i) + ".bin"), cloud);
  }
  folder.write("velodyne_points/timestamps.txt", "2011-09-26 13:02:25.951199337\n2011-09-26 13:02:26.054\n");
  const auto log = open_log(folder.path());
  EXPECT_EQ(log->info().format, "kitti-raw");
  EXPECT_NEAR(log->stamp_s(0), 1317042145.951199337, 1e-5);
  const ScanReading reading = log->read_closely(1);
  EXPECT_TRUE(reading.times_rebuilt);
  EXPECT_NEAR(reading.scan.cloud.time_offset_s[0], 0.0, 1e-6);
  EXPECT_NEAR(reading.scan.cloud.time_offset_s[1], -0.025, 1e-6);
  EXPECT_NEAR(reading.scan.cloud.time_offset_s[2], 0.025, 1e-6);
}

TEST(DriveLog, TimesThatDoNotRiseAreReplacedAndSaid) {
  const TemporaryFolder folder;
  write_kitti_scans(folder.path(), 8);
  folder.write("times.txt", "10\n10.1\n10.3\n10.2\n10.4\n10.4\n10.4\n10.7\n");
  const auto log = open_log(folder.path());
  EXPECT_THAT(log->info().problem, HasSubstr("3 times do not rise"));
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(log->stamp_s(i), 10.0 + 0.1 * static_cast<double>(i), 0.101) << i;  // one of two that are swapped stays
    EXPECT_TRUE(i == 0 || log->stamp_s(i) > log->stamp_s(i - 1)) << i;
  }
  folder.write("times.txt", "5\n5\n5\n5\n5\n5\n5\n5\n");
  EXPECT_NEAR(open_log(folder.path())->stamp_s(7) - open_log(folder.path())->stamp_s(0), 0.7, 1e-9);
  folder.write("times.txt", "0\n0.1\n0.2\n0.3\n0.4\n0.5\n0.6\n0.7\n");
  EXPECT_EQ(open_log(folder.path())->info().problem, "");
}

TEST(DriveLog, SweepHintsAreUnderstood) {
  const SweepHint hint = parse_sweep_hint("Counter-clockwise, seam at the front; 0.05 s a sweep, motion compensated");
  ASSERT_TRUE(hint.model.has_value());
  EXPECT_FALSE(hint.model->clockwise);
  EXPECT_DOUBLE_EQ(hint.model->seam_azimuth_rad, 0.0);
  EXPECT_DOUBLE_EQ(hint.model->period_s, 0.05);
  EXPECT_EQ(hint.motion_compensated, true);
  EXPECT_EQ(parse_sweep_hint("NOT motion compensated").motion_compensated, false);
  EXPECT_FALSE(parse_sweep_hint("nothing of use").model.has_value());
}

TEST(DriveLog, StampsInFileNames) {
  const TemporaryFolder folder;
  for (const char* name : {"1567410201745205000.pcd", "1567410201845205000.pcd"}) {
    write_pcd(folder / name, random_cloud(60));
  }
  const auto log = open_log(folder.path());
  EXPECT_TRUE(log->info().stamps_given);
  EXPECT_NEAR(log->stamp_s(1), 1567410201.845205, 1e-5);
  EXPECT_EQ(log->frame_number(1), 1U);
}

TEST(DriveLog, NanosecondsInFileNamesThatNobodyPadded) {
  const TemporaryFolder folder;
  for (const char* name : {"1741286117.5000000.pcd", "1741286117.105000000.pcd", "1741286117.205000000.pcd"}) {
    write_pcd(folder / name, random_cloud(60));
  }
  const auto log = open_log(folder.path());
  EXPECT_NEAR(log->stamp_s(0), 1741286117.005, 1e-6);
  EXPECT_NEAR(log->stamp_s(1), 1741286117.105, 1e-6);
  EXPECT_NEAR(log->stamp_s(2), 1741286117.205, 1e-6);
}

TEST(DriveLog, FractionsInFileNamesWithoutTheirLastZerosComeInOrderOfTime) {
  const TemporaryFolder folder;
  for (const char* name : {"1741286117.5.pcd", "1741286117.605.pcd", "1741286117.41.pcd"}) {
    write_pcd(folder / name, random_cloud(60));
  }
  const auto log = open_log(folder.path());
  EXPECT_NEAR(log->stamp_s(0), 1741286117.41, 1e-6);
  EXPECT_NEAR(log->stamp_s(1), 1741286117.5, 1e-6);
  EXPECT_THAT(log->scan_name(1), HasSubstr("117.5.pcd"));
}

TEST(DriveLog, MulRanPosesAreThoseOfTheOuster) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "Ouster");
  write_bin(folder / "Ouster/1561000444390000000.bin", random_cloud(60));
  folder.write("global_pose.csv",
               "1561000444000000000,1,0,0,10,0,1,0,0,0,0,1,0\n"
               "1561000445000000000,1,0,0,20,0,1,0,0,0,0,1,0\n");
  const auto log = open_log(folder.path());
  EXPECT_EQ(log->info().format, "mulran");
  EXPECT_NEAR(log->truth().at(0).translation().x(), 13.9 + 1.7042, 1e-4);
}

TEST(DriveLog, RawlogsAreLogsLikeOthers) {
  const TemporaryFolder folder;
  mrpt_bridge::RawlogWriter writer(folder / "drive.rawlog", "top");
  PointCloud cloud = random_cloud(60);
  cloud.points[3].setConstant(std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < 3; ++i) {
    writer.add({i, 50.0 + static_cast<double>(i), cloud}, forward_poses(3)[i]);
  }
  writer.add({3, 53.0, random_cloud(9)});
  writer.finish();
  const auto log = open_log(folder.path());
  EXPECT_EQ(log->info().format, "rawlog");
  EXPECT_EQ(log->size(), 4U);
  EXPECT_NEAR(log->truth().at(2).translation().x(), 2.0, 1e-9);
  const ScanReading reading = log->read_closely(1);
  EXPECT_EQ(reading.scan.cloud.size(), 59U);
  EXPECT_EQ(reading.dropped.not_finite, 1U);
  EXPECT_TRUE(reading.times_in_file);
  EXPECT_THAT(message_of<DamagedScan>([&] { log->read(3); }), HasSubstr("9 usable points"));
}

TEST(DriveLog, BadInputIsNamed) {
  const TemporaryFolder folder;
  const auto problem = [&](const std::string& name, const LogOptions& options = {}) {
    return message_of<InputError>([&] { open_log(folder / name, options); });
  };
  EXPECT_THAT(problem("missing"), HasSubstr("no such file"));
  fs::create_directories(folder / "empty");
  EXPECT_THAT(problem("empty"), HasSubstr("empty"));
  folder.write("text/readme.txt", "x");
  EXPECT_THAT(problem("text"), HasSubstr("no drive log"));
  write_kitti_scans(folder / "times", 3);
  folder.write("times/times.txt", "0\n0.1\n");
  EXPECT_THAT(problem("times"), HasSubstr("2 times for 3 scans"));
  folder.write("times/times.txt", "0\n0.1\nsoon\n");
  EXPECT_THAT(problem("times"), HasSubstr("times.txt:3"));
  LogOptions options;
  options.rate_hz = 0.0;
  EXPECT_THAT(problem("times", options), HasSubstr("rate_hz"));
  options = {};
  options.format = "rosbag";
  EXPECT_THAT(problem("times", options), HasSubstr("rosbag"));
}

TEST(DriveLog, PosesOfAnotherLengthAreNotUsedAndSaid) {
  const TemporaryFolder folder;
  write_kitti_scans(folder.path(), 4);
  write_kitti(folder / "poses.txt", forward_poses(3));
  std::string warned;
  set_log_sink([&](Severity, const std::string& message) { warned += message; });
  const auto log = open_log(folder.path());
  set_log_sink({});
  EXPECT_FALSE(log->info().truth_given);
  EXPECT_THAT(log->info().truth_problem, HasSubstr("3 poses for 4 scans"));
  EXPECT_THAT(warned, HasSubstr("3 poses for 4 scans"));
}

TEST(DriveLog, ScansWithFewPointsAreDamaged) {
  const TemporaryFolder folder;
  write_pcd(folder / "0.pcd", random_cloud(10));
  const auto log = open_log(folder.path());
  EXPECT_THAT(message_of<DamagedScan>([&] { log->read(0); }), HasSubstr("10 usable points"));
}

TEST(DriveLog, TimesOfPointsReferToTheStampAcrossTimeZones) {
  const fs::path folder = fs::path(LOOPMARK_SHARED_DIR) / "logs/reader_samples/opencalib_lidar2imu";
  if (!fs::exists(folder)) {
    GTEST_SKIP() << folder << " is not there";
  }
  const auto log = open_log(folder);
  ASSERT_EQ(log->size(), 5U);
  const Scan scan = log->read(0);
  EXPECT_NEAR(scan.cloud.time_offset_s.front(), 0.369082 - 0.468, 1e-4);
}

}  // namespace
}  // namespace loopmark::io

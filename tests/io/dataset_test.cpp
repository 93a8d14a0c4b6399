// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/dataset.hpp"

#include <gmock/gmock.h>

#include "io/io_fixtures.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark::io {
namespace {

namespace fs = std::filesystem;
using testing::bytes_of;
using ::testing::HasSubstr;
using testing::message_of;
using testing::random_cloud;
using testing::TemporaryFolder;

/// A cloud that tells which one it is: its size.
PointCloud marked_cloud(std::size_t mark) { return random_cloud(100 + mark, mark); }

TEST(Dataset, KittiOdometryWithCentralPoses) {
  const TemporaryFolder folder;
  for (const char* sequence : {"08", "10"}) {
    fs::create_directories(folder.path() / "sequences" / sequence / "velodyne");
    write_bin(folder.path() / "sequences" / sequence / "velodyne/000000.bin", marked_cloud(0));
    write_bin(folder.path() / "sequences" / sequence / "velodyne/000003.bin", marked_cloud(3));
    folder.write("sequences/" + std::string(sequence) + "/times.txt", "0\n0.1\n0.2\n0.3\n");
  }
  folder.write("poses/10.txt", kitti_text(std::vector<Pose>(4, pose_from_yaw(0.0, {1, 2, 3}))));
  const auto set = open_dataset(folder.path());
  EXPECT_EQ(set->layout(), "kitti-odometry");
  ASSERT_EQ(set->sessions().size(), 2U);
  EXPECT_EQ(set->load(10, 3).size(), 103U);
  EXPECT_EQ(set->poses(10).size(), 2U);
  EXPECT_TRUE(set->poses(8).empty());
  EXPECT_THAT(message_of<InputError>([&] { set->load(10, 1); }), HasSubstr("frame 1 does not exist"));
  EXPECT_THAT(message_of<InputError>([&] { set->load(9, 0); }), HasSubstr("no such session"));
}

TEST(Dataset, KittiRawHasPosesFromItsGps) {
  const TemporaryFolder folder;
  const std::string drive = "2011_09_26/2011_09_26_drive_0005_sync/";
  fs::create_directories(folder / (drive + "velodyne_points/data"));
  for (int i = 0; i < 2; ++i) {
    write_bin(folder / (drive + "velodyne_points/data/000000000" + std::to_string(i) + ".bin"), marked_cloud(7));
    // 1e-5 degrees of latitude are 1.11 m to the north, where the car with its yaw of 90 degrees looks.
    folder.write(drive + "oxts/data/000000000" + std::to_string(i) + ".txt",
                 std::to_string(49.0 + 1e-5 * i) + " 8.4 110 0 0 1.5707963267948966 0 0 0 0 0\n");
  }
  folder.write("2011_09_26/calib_imu_to_velo.txt", "calib_time: x\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
  const auto set = open_dataset(folder.path());
  EXPECT_EQ(set->layout(), "kitti-raw");
  ASSERT_EQ(set->poses(0).size(), 2U);
  EXPECT_LT((set->poses(0)[1].translation() - Eigen::Vector3d(1.1132, 0, 0)).norm(), 1e-3);
  EXPECT_EQ(set->load(0, 1).size(), 107U);
}

TEST(Dataset, RawlogsAreSessionsToo) {
  const TemporaryFolder folder;
  for (const char* name : {"b.rawlog", "a.rawlog"}) {
    mrpt_bridge::RawlogWriter writer(folder / name, "top");
    writer.add({0, 1.0, marked_cloud(name[0] == 'a' ? 1 : 2)});
    writer.finish();
  }
  const auto set = open_dataset(folder.path(), {}, {});
  ASSERT_EQ(set->sessions().size(), 2U);
  EXPECT_EQ(set->load(1, 0).size(), 102U);
}

TEST(Dataset, ApolloCountsFromOneInTheOrderOfThePublishedSets) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "HighWay237/Apollo-SourthBay/TestData/HighWay237/2018-10-12";
  fs::create_directories(drive / "pcds");
  fs::create_directories(drive / "poses");
  std::ofstream poses(drive / "poses/gt_poses.txt");
  for (int i = 1; i <= 3; ++i) {
    write_pcd(drive / "pcds" / (std::to_string(i) + ".pcd"), marked_cloud(static_cast<std::size_t>(i)));
    poses << i << " " << 100.0 + i << " " << 10 * i << " 0 0 0 0 0.7071067811865476 0.7071067811865476\n";
  }
  poses.close();
  const auto set = open_dataset(folder.path());
  EXPECT_EQ(set->layout(), "apollo-southbay");
  EXPECT_EQ(set->load(20, 1).size(), 101U);
  EXPECT_NEAR(set->poses(20)[2].translation().x(), 30.0, 1e-12);
  EXPECT_NEAR(set->poses(20)[2].linear()(1, 0), 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(set->log(20).stamp_s(0), 101.0);
  EXPECT_THAT(message_of<InputError>([&] { set->load(20, 0); }), HasSubstr("counts from 1"));
  EXPECT_THAT(message_of<InputError>([&] { set->load(26, 1); }), HasSubstr("is not there"));
}

TEST(Dataset, MulRanDrivesAreSessionsByName) {
  const TemporaryFolder folder;
  for (const char* drive : {"Riverside02", "KAIST03"}) {
    fs::create_directories(folder.path() / drive / "Ouster");
    write_bin(folder.path() / drive / "Ouster/1561000444390000000.bin", marked_cloud(drive[0] == 'K' ? 1 : 2));
  }
  const auto set = open_dataset(folder.path());
  EXPECT_EQ(set->layout(), "mulran");
  EXPECT_EQ(set->sessions()[0].name, "KAIST03");
  EXPECT_EQ(set->load(0, 0).size(), 101U);
}

TEST(Dataset, SessionsFileNamesTheLogs) {
  const TemporaryFolder folder;
  for (const char* name : {"one", "two"}) {
    fs::create_directories(folder.path() / "logs" / name);
    write_pcd(folder.path() / "logs" / name / "000000.pcd", marked_cloud(name[0] == 'o' ? 1 : 2));
  }
  const fs::path file = folder.write("sessions.txt", "index name\n7 two\n8 one\n9 three\n");
  const auto set = open_dataset(folder / "logs", file);
  EXPECT_EQ(set->load(7, 0).size(), 102U);
  EXPECT_FALSE(set->sessions()[2].present);
  EXPECT_THAT(message_of<InputError>([&] { set->load(9, 0); }), HasSubstr("three"));
  EXPECT_EQ(open_dataset(folder / "logs")->load(0, 0).size(), 101U);
  folder.write("sessions.txt", "7 two\n7 one\n");
  EXPECT_THAT(message_of<InputError>([&] { open_dataset(folder / "logs", file); }), HasSubstr("sessions.txt:2"));
}

/// nuScenes tables of two scenes; the second has one key frame and two sweeps.
void write_nuscenes(const TemporaryFolder& folder, const std::string& version) {
  const std::string tables = version + "/";
  folder.write(tables + "scene.json", R"([{"token":"s0","name":"scene-0061","first_sample_token":"a0"},
    {"token":"s1","name":"scene-0103","first_sample_token":"a1"}])");
  const auto sweep = [](const char* token, const char* sample, const char* next, bool key, const char* channel) {
    return std::string("{\"token\":\"") + token + "\",\"sample_token\":\"" + sample + "\",\"ego_pose_token\":\"e_" +
           token + "\",\"calibrated_sensor_token\":\"c\",\"timestamp\":15326000004" + token[1] +
           "0000,\"is_key_frame\":" + (key ? "true" : "false") + ",\"filename\":\"sweeps/" + channel + "/" + token +
           ".pcd.bin\",\"prev\":\"\",\"next\":\"" + next + "\"}";
  };
  folder.write(tables + "sample_data.json",
               "[" + sweep("x0", "a0", "", true, "LIDAR_TOP") + "," + sweep("w2", "a2", "", false, "LIDAR_TOP") + "," +
                   sweep("r0", "a1", "", true, "RADAR_FRONT") + "," + sweep("w0", "a1", "w1", true, "LIDAR_TOP") + "," +
                   sweep("w1", "a2", "w2", false, "LIDAR_TOP") + "]");
  std::string poses;
  int x = 0;
  for (const char* token : {"x0", "w0", "w1", "w2", "r0"}) {
    poses += std::string(poses.empty() ? "[" : ",") + "{\"token\":\"e_" + token + "\",\"rotation\":[1,0,0,0]," +
             "\"translation\":[" + std::to_string(10 * x++) + ",0,0]}";
  }
  folder.write(tables + "ego_pose.json", poses + "]");
  folder.write(tables + "calibrated_sensor.json",
               R"([{"token":"c","translation":[1,0,2],"rotation":[0.7071067811865476,0,0,-0.7071067811865476]}])");
  std::string bytes;
  for (int i = 0; i < 60; ++i) {
    for (const float value : {0.0F, 5.0F, 1.0F, 9.0F, 3.0F}) {
      bytes += bytes_of(value);
    }
  }
  for (const char* token : {"x0", "w0", "w1", "w2"}) {
    folder.write(std::string("sweeps/LIDAR_TOP/") + token + ".pcd.bin", bytes);
  }
}

TEST(Dataset, NuScenesScenesInTheCarsFrame) {
  const TemporaryFolder folder;
  write_nuscenes(folder, "v1.0-mini");
  const auto set = open_dataset(folder.path());
  EXPECT_EQ(set->layout(), "nuscenes");
  ASSERT_EQ(set->sessions().size(), 2U);
  const DriveLog& log = set->log(1);
  ASSERT_EQ(log.size(), 3U);
  EXPECT_NEAR(log.stamp_s(1) - log.stamp_s(0), 0.01, 1e-6);
  EXPECT_NEAR(set->poses(1)[2].translation().x(), 30.0, 1e-9);
  // The sensor looks along the car's -y: its y axis is the car's x axis.
  EXPECT_LT((set->load(1, 2).points[0] - Eigen::Vector3f(6, 0, 3)).norm(), 1e-5F);
  EXPECT_THAT(message_of<InputError>([&] { set->load(1, 3); }), HasSubstr("frame 3 does not exist"));
}

TEST(Dataset, SeveralNuScenesVersionsMustBeChosenFrom) {
  const TemporaryFolder folder;
  write_nuscenes(folder, "v1.0-test");
  write_nuscenes(folder, "v1.0-trainval");
  EXPECT_THAT(message_of<InputError>([&] { open_dataset(folder.path()); }), HasSubstr("dataset.version"));
  DatasetOptions options;
  options.version = "v1.0-test";
  EXPECT_EQ(open_dataset(folder.path(), {}, options)->sessions().size(), 2U);
}

TEST(Dataset, BrokenNuScenesTablesAreNamed) {
  const TemporaryFolder folder;
  write_nuscenes(folder, "v1.0-mini");
  folder.write("v1.0-mini/ego_pose.json", "[{\"token\":");
  const auto set = open_dataset(folder.path());
  EXPECT_THAT(message_of<InputError>([&] { set->load(0, 0); }), HasSubstr("ego_pose.json"));
}

TEST(Dataset, NothingThereIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(open_dataset(folder / "missing"), InputError);
  folder.write("readme.txt", "x");
  EXPECT_THAT(message_of<InputError>([&] { open_dataset(folder.path()); }), HasSubstr("no data set"));
  DatasetOptions options;
  options.layout = "waymo";
  EXPECT_THAT(message_of<InputError>([&] { open_dataset(folder.path(), {}, options); }), HasSubstr("waymo"));
}

}  // namespace
}  // namespace loopmark::io

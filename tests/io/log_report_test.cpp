// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_report.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "io/io_fixtures.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"

namespace loopmark::io {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::random_cloud;
using testing::TemporaryFolder;

/// A sweep of `beams` between two elevations on a cylinder of 20 m, ring after ring or firing after firing.
PointCloud sweep(std::size_t beams, double low_deg, double high_deg, bool ring_after_ring) {
  constexpr std::size_t kColumns = 300;
  PointCloud cloud;
  for (std::size_t k = 0; k < beams * kColumns; ++k) {
    const std::size_t beam = ring_after_ring ? k / kColumns : k % beams;
    const std::size_t column = ring_after_ring ? k % kColumns : k / beams;
    const double elevation =
        (low_deg + (high_deg - low_deg) * static_cast<double>(beam) / static_cast<double>(beams - 1)) / 180 *
        std::numbers::pi;
    const double azimuth = -2.0 * std::numbers::pi * (static_cast<double>(column) + 0.5) / kColumns;
    cloud.points.emplace_back(static_cast<float>(20 * std::cos(azimuth)), static_cast<float>(20 * std::sin(azimuth)),
                              static_cast<float>(20 * std::tan(elevation)));
    cloud.ring.push_back(static_cast<std::uint16_t>(beam));
  }
  return cloud;
}

TEST(GuessSensor, ByRingsByOrderAndByElevation) {
  PointCloud cloud = sweep(16, -15, 15, false);
  EXPECT_EQ(guess_sensor(cloud).beams, 16U);
  EXPECT_EQ(guess_sensor(cloud).beams_from, "rings");
  EXPECT_EQ(guess_sensor(cloud).name, "VLP-16");
  cloud.ring.clear();
  EXPECT_EQ(guess_sensor(cloud).beams, 16U);
  EXPECT_EQ(guess_sensor(cloud).beams_from, "elevations");
  cloud = sweep(64, -24.8, 2.0, true);
  cloud.ring.clear();
  EXPECT_EQ(guess_sensor(cloud).beams, 64U);
  EXPECT_EQ(guess_sensor(cloud).beams_from, "order of the points");
  EXPECT_EQ(guess_sensor(cloud).name, "HDL-64E");
}

TEST(GuessSensor, ThinnedCloudsAreNotGuessedAt) {
  PointCloud cloud = random_cloud(5000);
  cloud.ring.clear();
  EXPECT_EQ(guess_sensor(cloud).beams, 0U);
}

TEST(ExamineStamps, GapsRepetitionsAndReturns) {
  std::vector<double> stamps;
  for (int i = 0; i < 40; ++i) {
    stamps.push_back(0.1 * i);
  }
  EXPECT_TRUE(examine_stamps(stamps).regular);
  EXPECT_NEAR(examine_stamps(stamps).rate_hz, 10.0, 1e-6);
  for (std::size_t i = 20; i < 40; ++i) {
    stamps[i] += 3.0;
  }
  stamps[30] = stamps[29];
  stamps[35] = stamps[34] - 0.05;
  const StampFacts facts = examine_stamps(stamps);
  ASSERT_GE(facts.gaps.size(), 1U);
  EXPECT_EQ(facts.gaps[0].before, 20U);
  EXPECT_NEAR(facts.gaps[0].seconds, 3.1, 1e-9);
  EXPECT_THAT(facts.repeated, ElementsAre(30));
  EXPECT_THAT(facts.backwards, ElementsAre(35));
  EXPECT_FALSE(examine_stamps({0.0, 6.0, 7.0, 12.0}).regular);
  EXPECT_EQ(examine_stamps({5.0}).rate_hz, 0.0);
}

TEST(ExamineLog, EverythingIsFoundAndNothingChanged) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "velodyne");
  for (int i = 0; i < 8; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "velodyne/%06d.pcd", i);
    write_pcd(folder / name, random_cloud(200, i == 5 ? 4 : static_cast<std::uint64_t>(i)));
  }
  folder.write("velodyne/000002.pcd", "");
  folder.write("times.txt", "0\n0.1\n0.2\n0.3\n0.4\n0.5\n0.6\n0.7\n");
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i) {
    poses.push_back(pose_from_yaw(0.0, {0.5 * i, 0, 0}));
  }
  write_kitti(folder / "poses.txt", poses);
  const auto changed = fs::last_write_time(folder / "velodyne");
  const LogReport report = examine_log(*open_log(folder.path()));
  EXPECT_EQ(fs::last_write_time(folder / "velodyne"), changed);
  EXPECT_EQ(report.scans, 8U);
  EXPECT_EQ(report.usable, 7U);
  ASSERT_EQ(report.damaged.size(), 1U);
  EXPECT_EQ(report.damaged[0].index, 2U);
  EXPECT_THAT(report.copies, ElementsAre(5));
  EXPECT_EQ(report.points_median, 200U);
  EXPECT_EQ(report.point_times, PointTimeSource::kInFiles);
  EXPECT_NEAR(report.sweep_last_s, 0.0995, 1e-6);
  EXPECT_NEAR(report.truth_length_m, 3.5, 1e-6);
  const std::string text = report_text(report);
  EXPECT_THAT(text, HasSubstr("000002.pcd"));
  EXPECT_THAT(text, HasSubstr("loopmark map"));
  EXPECT_THAT(report_json(report), HasSubstr("\"usable\": 7"));
}

TEST(ExamineDataset, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  write_pcd((fs::create_directories(folder / "one"), folder / "one/000000.pcd"), random_cloud(80));
  folder.write("two/000000.pcd", "");
  const fs::path file = folder.write("sessions.txt", "0 one\n1 two\n2 three\n");
  const DatasetReport report = examine_dataset(*open_dataset(folder.path(), file));
  ASSERT_EQ(report.sessions.size(), 3U);
  EXPECT_EQ(report.sessions[0].points, 80U);
  EXPECT_THAT(report.sessions[1].problem, HasSubstr("empty"));
  const std::string text = report_text(report);
  EXPECT_THAT(text, HasSubstr("three: not there"));
  EXPECT_THAT(text, HasSubstr("1 drives usable, 1 not there, 1 with problems"));
  EXPECT_THAT(report_json(report), HasSubstr("\"present\": false"));
}

}  // namespace
}  // namespace loopmark::io

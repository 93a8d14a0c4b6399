// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Input that people really have and that once came out as a whole map of nothing: it is read rightly, or refused with
// its likely cause.
#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "app/sweep_logs.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using testing_support::run_program;
using testing_support::StreetLogs;

/// The clouds of a log of sweeps, as written.
std::vector<PointCloud> clouds_of(const fs::path& log) {
  std::vector<PointCloud> clouds;
  for (int i = 0; i < StreetLogs::kScans; ++i) {
    clouds.push_back(io::read_point_file(log / StreetLogs::scan_name(i)).cloud);
  }
  return clouds;
}

/// x y z intensity ring, all float32: the layout of nuScenes under KITTI's ending.
void write_five_floats(const fs::path& file, const PointCloud& cloud) {
  std::string bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    const float values[5] = {p.x(), p.y(), p.z(), static_cast<float>((7 * i) % 100), cloud.intensity[i]};
    bytes.append(reinterpret_cast<const char*>(values), sizeof values);
  }
  storage::write_file_atomically(file, bytes);
}

nlohmann::json summary_of(const fs::path& run) {
  return nlohmann::json::parse(storage::read_file(run / "summary.json"));
}

/// A log without times of points and without poses, made of clouds.
fs::path plain_log(const StreetLogs& logs, const std::string& name, const std::vector<PointCloud>& clouds) {
  const fs::path log = logs.scratch(name);
  fs::create_directories(log);
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    PointCloud cloud = clouds[i];
    cloud.time_offset_s.clear();
    io::write_pcd(log / StreetLogs::scan_name(static_cast<int>(i)), cloud);
  }
  return log;
}

class SilentInput : public testing::Test {
 protected:
  StreetLogs logs_{"silent_input"};
  fs::path log_ = logs_.make_log("log");
};

TEST_F(SilentInput, BinFilesOfFiveFloatsAreReadAsTheyShow) {
  const fs::path five = logs_.scratch("five");
  fs::create_directories(five);
  const std::vector<PointCloud> clouds = clouds_of(log_);
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.bin", i);
    write_five_floats(five / name, clouds[i]);
  }
  const PointCloud read = io::read_point_file(five / "000000.bin").cloud;
  ASSERT_EQ(read.size(), clouds[0].size());
  EXPECT_EQ(read.points, clouds[0].points);
  const auto registered =
      run_program({"register", five / "000002.bin", log_ / StreetLogs::scan_name(0), "--set", "log.bin_columns=4"});
  EXPECT_THAT(registered.output, ::testing::Not(HasSubstr("verdict       answered")));  // the option is used
}

TEST_F(SilentInput, ScansInAWorldFrameAreRefused) {
  const std::vector<Pose> poses = io::read_trajectory(log_ / "poses.txt").poses;
  const testing_support::BoxWorld world = testing_support::street(120.0, 5);
  std::vector<PointCloud> clouds;
  for (std::size_t i = 0; i < poses.size(); ++i) {  // compensated, as registered clouds are
    const PointCloud cloud = testing_support::sweep(world, poses[i], Vector6d::Zero(), 0.02, i);
    clouds.push_back(transformed(cloud, poses[0].inverse() * poses[i]));
  }
  const fs::path log = plain_log(logs_, "world", clouds);
  const auto mapped = run_program({"map", log, "-o", logs_.new_run("world_run")});
  EXPECT_EQ(mapped.exit_code, 2);
  EXPECT_THAT(mapped.output, HasSubstr("world frame"));
  EXPECT_THAT(run_program({"doctor", log}).output, HasSubstr("world frame"));
}

TEST_F(SilentInput, MillimetresAreNamed) {
  std::vector<PointCloud> clouds = clouds_of(log_);
  for (Eigen::Vector3f& point : clouds[0].points) {
    point *= 1000.0F;
  }
  io::write_pcd(log_ / StreetLogs::scan_name(0), clouds[0]);
  const auto registered = run_program({"register", log_ / StreetLogs::scan_name(0), log_ / StreetLogs::scan_name(1)});
  EXPECT_EQ(registered.exit_code, 2);
  EXPECT_THAT(registered.output, HasSubstr("millimetres"));
}

TEST_F(SilentInput, TimesOfPointsThatAreOfNoUseAreNamed) {
  const fs::path log = plain_log(logs_, "no_times", clouds_of(log_));
  const auto mapped = run_program(testing_support::map_words(log, logs_.new_run("no_times_run")));
  EXPECT_EQ(mapped.exit_code, 2);
  EXPECT_THAT(mapped.output, HasSubstr("000000.pcd"));
  EXPECT_THAT(mapped.output, HasSubstr("raw_given_times"));
}

TEST_F(SilentInput, CopiesOfScansAreNoMotion) {
  const fs::path twice = logs_.scratch("twice");
  fs::create_directories(twice);
  std::vector<double> stamps;
  for (int i = 0; i < 2 * StreetLogs::kScans; ++i) {
    fs::copy_file(log_ / StreetLogs::scan_name(i / 2), twice / StreetLogs::scan_name(i));
    stamps.push_back(0.05 * i);
  }
  StreetLogs::write_times(twice, stamps);
  const fs::path once_run = logs_.new_run("once_run");
  const fs::path twice_run = logs_.new_run("twice_run");
  ASSERT_EQ(run_program(testing_support::map_words(log_, once_run)).exit_code, 0);
  ASSERT_EQ(run_program(testing_support::map_words(twice, twice_run)).exit_code, 0);
  EXPECT_EQ(summary_of(twice_run)["recovered"], 0);
  EXPECT_EQ(summary_of(twice_run)["keyframes"], summary_of(once_run)["keyframes"]);
  EXPECT_NEAR(summary_of(twice_run)["path_m"].get<double>(), summary_of(once_run)["path_m"].get<double>(), 0.02);
}

TEST_F(SilentInput, TruthIsJoinedByTime) {
  const io::Trajectory truth = {{}, io::read_trajectory(log_ / "poses.txt").poses};
  std::vector<double> stamps;
  std::vector<double> a_day_later;
  for (std::size_t i = truth.poses.size(); i > 0; --i) {  // the last one first
    stamps.push_back(0.1 * static_cast<double>(i - 1));
    a_day_later.push_back(stamps.back() + 86400.0);
  }
  const std::vector<Pose> backwards(truth.poses.rbegin(), truth.poses.rend());
  io::write_tum(log_ / "backwards.tum", stamps, backwards);
  io::write_tum(log_ / "other_day.tum", a_day_later, backwards);
  const fs::path run = logs_.new_run("truth_run");
  const auto mapped = run_program(testing_support::map_words(log_, run, {"--truth", log_ / "backwards.tum"}));
  ASSERT_EQ(mapped.exit_code, 0) << mapped.output;
  EXPECT_LT(summary_of(run)["ate_rmse_m"].get<double>(), 0.2);  // joined line by line it is metres
  const auto refused =
      run_program(testing_support::map_words(log_, logs_.new_run("other_day"), {"--truth", log_ / "other_day.tum"}));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output, HasSubstr("0 of 24 scans have a pose at their time"));
}

TEST_F(SilentInput, AViewpointThatIsNotAppliedIsSaid) {
  std::string bytes = storage::read_file(log_ / StreetLogs::scan_name(0));
  const std::string still = "VIEWPOINT 0 0 0 1 0 0 0";
  ASSERT_NE(bytes.find(still), std::string::npos);
  bytes.replace(bytes.find(still), still.size(), "VIEWPOINT 20 5 1 0.8660254 0 0 0.5");
  storage::write_file_atomically(log_ / StreetLogs::scan_name(0), bytes);
  EXPECT_THAT(run_program({"register", log_ / StreetLogs::scan_name(0), log_ / StreetLogs::scan_name(1)}).output,
              HasSubstr("VIEWPOINT"));
  EXPECT_THAT(run_program({"doctor", log_}).output, HasSubstr("1 scans have a VIEWPOINT"));
}

}  // namespace
}  // namespace loopmark::app

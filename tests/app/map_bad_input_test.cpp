// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark map on logs and places that are not as they should be: it names what is wrong, or leaves it out and says so.
#include <gmock/gmock.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <limits>

#include "app/sweep_logs.hpp"
#include "loopmark/mapping/trajectory_metrics.hpp"
#include "loopmark/mrpt_bridge/rawlog.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::ProgramResult;
using testing_support::RunningProgram;
using testing_support::StreetLogs;

constexpr std::size_t kScans = StreetLogs::kScans;
const StreetLogs kLogs{"map_bad_input_test"};

ProgramResult map(const fs::path& log, const fs::path& run, const std::vector<std::string>& more = {},
                  const std::function<void()>& prepare = {}) {
  return RunningProgram(testing_support::map_words(log, run, more), LOOPMARK_BINARY, prepare).wait();
}

/// How far the trajectory of a run is from the poses of its log at most, metres.
double worst_m(const fs::path& run, const std::vector<Pose>& truth) {
  return mapping::absolute_error(io::read_trajectory(run / "trajectory.tum").poses, truth).max_m;
}

std::vector<Pose> truth_of(const fs::path& log) { return io::read_trajectory(log / "poses.txt").poses; }

PointCloud scan_of(const fs::path& log, int scan) {
  return io::read_point_file(log / StreetLogs::scan_name(scan)).cloud;
}

TEST(MapBadInput, PointsThatMakeNoSenseAreLeftOutAndScansOfFewPointsSkipped) {
  const fs::path log = kLogs.make_log("senseless");
  PointCloud cloud = scan_of(log, 7);
  for (std::size_t i = 0; i < cloud.size(); i += 10) {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    const float values[] = {std::nanf(""), kInf, -kInf, 1e30F, 5e4F};
    cloud.points[i] = Eigen::Vector3f(values[i / 10 % 5], 1.0F, 1.0F);
  }
  io::write_pcd(log / StreetLogs::scan_name(7), cloud);
  cloud = scan_of(log, 13);
  std::vector<std::size_t> ten(10);
  for (std::size_t i = 0; i < ten.size(); ++i) {
    ten[i] = 100 * i;
  }
  io::write_pcd(log / StreetLogs::scan_name(13), select(cloud, ten));
  const fs::path run = kLogs.new_run("senseless_run");
  const ProgramResult result = map(log, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("1 damaged"));
  EXPECT_THAT(storage::read_file(run / "summary.json"), AllOf(HasSubstr("000013.pcd"), Not(HasSubstr("000007.pcd"))));
  EXPECT_LT(worst_m(run, truth_of(log)), 0.3);
}

TEST(MapBadInput, AllScansDamagedEndTheRunWithTheFirstThatWasTooMany) {
  const fs::path log = kLogs.make_log("all_damaged");
  for (std::size_t i = 0; i < kScans; ++i) {
    fs::resize_file(log / StreetLogs::scan_name(static_cast<int>(i)), i % 2 == 0 ? 0 : 100);
  }
  const ProgramResult result = map(log, kLogs.new_run("all_damaged_run"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, AllOf(HasSubstr("max_bad_scans"), HasSubstr("000010.pcd")));
  const ProgramResult patient = map(log, kLogs.new_run("patient_run"), {"--set", "slam.max_bad_scans=1000"});
  EXPECT_EQ(patient.exit_code, 2);
  EXPECT_THAT(patient.output, HasSubstr("no scan could be used"));
}

TEST(MapBadInput, GapsInTime) {
  const fs::path log = kLogs.make_log("gaps");
  std::vector<Pose> truth;
  for (std::size_t i = 0; i < kScans; ++i) {
    if (i >= 9 && i < 13) {  // 5 m on: the times of the scans that are left stand in times.txt by their numbers
      fs::remove(log / StreetLogs::scan_name(static_cast<int>(i)));
    } else {
      truth.push_back(truth_of(log)[i]);
    }
  }
  const fs::path run = kLogs.new_run("gaps_run");
  const ProgramResult result = map(log, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_LT(worst_m(run, truth), 0.3);
  EXPECT_THAT(storage::read_file(run / "summary.json"), HasSubstr("\"scans\": 20,"));
}

TEST(MapBadInput, TimesThatRepeatOrGoBackAreSaidAndDoNotBendTheMap) {
  const fs::path log = kLogs.make_log("times");
  std::vector<double> stamps;
  for (std::size_t i = 0; i < kScans; ++i) {
    stamps.push_back(0.1 * static_cast<double>(i));
  }
  std::swap(stamps[6], stamps[7]);
  stamps[12] = stamps[11];
  stamps[13] = stamps[11];
  stamps[18] = 1.5;
  StreetLogs::write_times(log, stamps);
  const fs::path run = kLogs.new_run("times_run");
  const ProgramResult result = map(log, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("times.txt: 4 times do not rise"), HasSubstr("is that of scan 6")));
  EXPECT_LT(worst_m(run, truth_of(log)), 0.3);
}

TEST(MapBadInput, PosesOfAnotherLengthAreSaidAndNotUsed) {
  const fs::path log = kLogs.make_log("poses");
  std::vector<Pose> poses = truth_of(log);
  poses.pop_back();
  io::write_kitti(log / "poses.txt", poses);
  const fs::path run = kLogs.new_run("poses_run");
  const ProgramResult result = map(log, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("23 poses for 24 scans; they are not used"), Not(HasSubstr("ATE"))));
}

/// The street log as a rawlog.
fs::path make_rawlog(const std::string& name) {
  const fs::path log = kLogs.make_log(name);
  const fs::path file = kLogs.scratch(name + ".rawlog");
  mrpt_bridge::RawlogWriter writer(file, "top");
  for (std::size_t i = 0; i < kScans; ++i) {
    writer.add({i, 100.0 + 0.1 * static_cast<double>(i), scan_of(log, static_cast<int>(i))});
  }
  writer.finish();
  return file;
}

TEST(MapBadInput, RawlogsThatCannotBeReadAreNamed) {
  const fs::path garbage = kLogs.scratch("garbage.rawlog");
  storage::write_file_atomically(garbage, std::string(5000, 'x'));
  const fs::path empty = kLogs.scratch("empty.rawlog");
  storage::write_file_atomically(empty, "");
  for (const fs::path& file : {garbage, empty}) {
    const fs::path run = kLogs.new_run("garbage_run");
    const ProgramResult result = map(file, run);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.output, HasSubstr("error: " + file.string()));
    EXPECT_FALSE(fs::exists(run.string() + ".partial")) << "there is nothing to resume";
  }
}

TEST(MapBadInput, OfARawlogThatIsCutOffTheScansBeforeAreMapped) {
  const fs::path file = make_rawlog("cut");
  fs::resize_file(file, fs::file_size(file) / 2);
  const fs::path run = kLogs.new_run("cut_run");
  const ProgramResult result = map(file, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("truncated"));
  const std::size_t found = io::read_trajectory(run / "trajectory.tum").poses.size();
  EXPECT_GT(found, 4U);
  EXPECT_LT(found, kScans);
}

TEST(MapBadInput, YamlThatIsNoneIsNamedWithItsLine) {
  const fs::path log = kLogs.make_log("yaml");
  const fs::path file = kLogs.scratch("wrong.yaml");
  const std::pair<const char*, const char*> cases[] = {{"slam:\n  keyframe_m: [1, 2\n", ":"},
                                                       {"slam:\n  keyframe_m: far\n", ":2"},
                                                       {"slam:\n  keyframe_metres: 2\n", ":2"},
                                                       {"slam: 3\n", ":1"}};
  for (const auto& [text, line] : cases) {
    storage::write_file_atomically(file, text);
    const fs::path run = kLogs.new_run("yaml_run");
    const ProgramResult result = map(log, run, {"--config", file});
    EXPECT_EQ(result.exit_code, 2) << text;
    EXPECT_THAT(result.output, HasSubstr("error: " + file.string() + line)) << text;
    EXPECT_FALSE(fs::exists(run.string() + ".partial")) << "nothing is begun";
  }
}

/// What may not be written: as an ordinary user, for nothing stops root.
class AsNobody : public testing::Test {
 protected:
  static constexpr uid_t kNobody = 65534;

  static void become_nobody() {
    if (::geteuid() == 0 && (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) {
      ::_exit(126);
    }
  }

  /// 126, 127: no such user, or it may not run the program where this one lies.
  static bool can_run() {
    const int code = RunningProgram({"--version"}, LOOPMARK_BINARY, become_nobody).wait().exit_code;
    return code == 0;
  }
};

TEST_F(AsNobody, AFolderThatMayNotBeWrittenIsNamed) {
  if (!can_run()) {
    GTEST_SKIP() << "the program cannot be run as an ordinary user here";
  }
  const fs::path log = kLogs.make_log("read_only");
  const fs::path folder = kLogs.scratch("read_only_folder");
  fs::create_directories(folder);
  ::chmod(folder.c_str(), 0555);
  const ProgramResult result = map(log, folder / "run", {}, become_nobody);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr((folder / "run.partial").string()), HasSubstr("Permission denied")));
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(AsNobody, ALogThatMayNotBeReadIsNamed) {
  if (!can_run()) {
    GTEST_SKIP() << "the program cannot be run as an ordinary user here";
  }
  const fs::path file = make_rawlog("unreadable");
  ::chmod(file.c_str(), 0);
  const fs::path log = kLogs.make_log("unreadable_scans");
  for (std::size_t i = 0; i < kScans; ++i) {
    ::chmod((log / StreetLogs::scan_name(static_cast<int>(i))).c_str(), 0);
  }
  const fs::path folder = kLogs.scratch("unreadable_folder");
  fs::remove_all(folder);
  fs::create_directories(folder);
  ::chmod(folder.c_str(), 0777);
  const ProgramResult rawlog = map(file, folder / "a", {}, become_nobody);
  EXPECT_EQ(rawlog.exit_code, 2) << rawlog.output;
  EXPECT_THAT(rawlog.output, HasSubstr("error: " + file.string()));
  const ProgramResult scans = map(log, folder / "b", {}, become_nobody);
  EXPECT_EQ(scans.exit_code, 2) << scans.output;
  EXPECT_THAT(scans.output, AllOf(HasSubstr("max_bad_scans"), HasSubstr("Permission denied")));
}

TEST(MapBadInput, AnOutputBelowAFileIsNamed) {
  const fs::path log = kLogs.make_log("below_a_file");
  const fs::path file = kLogs.scratch("file");
  storage::write_file_atomically(file, "x");
  const ProgramResult result = map(log, file / "run");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr((file / "run").string()));
}

}  // namespace
}  // namespace loopmark::app

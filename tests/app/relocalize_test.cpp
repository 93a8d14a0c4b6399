// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark relocalize as a user runs it, on short drives through a synthetic street whose truth is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "loopmark/storage/files.hpp"
#include "passing_log.hpp"
#include "relocalization_rows.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing_support::kPassingLogSetting;
using testing_support::ProgramResult;
using testing_support::relocalization_rows;
using testing_support::RelocalizationRow;
using testing_support::run_program;

/// Below a folder of this process alone: tests run side by side.
fs::path scratch(const std::string& name) {
  return fs::path(::testing::TempDir()) / ("loopmark_relocalize_" + std::to_string(::getpid())) / name;
}

fs::path fresh(const std::string& name) {
  fs::remove_all(scratch(name));
  fs::remove_all(scratch(name).string() + ".partial");
  return scratch(name);
}

class Relocalize : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    testing_support::write_passing_log(scratch("day1"), 0.0, 0);
    const ProgramResult mapped = run_program({"map", day1(), "-o", scratch("run"), "-q", "--set", kPassingLogSetting});
    ASSERT_EQ(mapped.exit_code, 0) << mapped.output;
  }
  static void TearDownTestSuite() { fs::remove_all(scratch("").parent_path()); }

  static fs::path day1() { return scratch("day1"); }

  /// Other scans of the street, a metre and a half to the left.
  static fs::path day2(const std::string& name, int count) {
    testing_support::write_passing_log(scratch(name), 1.5, 1000, count);
    return scratch(name);
  }

  static ProgramResult relocalize(const fs::path& log, const fs::path& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"relocalize", scratch("run"), log, "-o", out, "-q", "--set", kPassingLogSetting};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  static nlohmann::json summary(const fs::path& out) {
    return nlohmann::json::parse(storage::read_file(out / "summary.json"));
  }

  /// Of an answer, from the truth of a log of day2(): scans a metre apart.
  static double error_m(const RelocalizationRow& row) {
    return (row.T_map_lidar.translation() - Eigen::Vector3d(static_cast<double>(row.scan), 1.5, 0.0)).norm();
  }
};

/// Without the scans from `first` to before `end`, so that the sensor jumps there, `gap_s` later.
void cut_out(const fs::path& log, std::size_t first, std::size_t end, double gap_s) {
  std::vector<Pose> poses = io::read_trajectory(log / "poses.txt").poses;
  std::vector<Pose> kept;
  std::ofstream times(log / "times.txt");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    char file[32];
    std::snprintf(file, sizeof file, "%06zu.pcd", i);
    if (i >= first && i < end) {
      fs::remove(log / file);
      continue;
    }
    times << 0.1 * static_cast<double>(kept.size()) + (i >= end ? gap_s : 0.0) << "\n";
    kept.push_back(poses[i]);
  }
  times.close();
  io::write_kitti(log / "poses.txt", kept);
}

TEST_F(Relocalize, EveryScanOfAnotherDriveIsFollowedOnceItIsFound) {
  const fs::path out = fresh("out");
  const ProgramResult result = relocalize(day2("day2", 30), out, {"--map-truth", day1() / "poses.txt"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_FALSE(fs::exists(out.string() + ".partial"));
  const std::vector<RelocalizationRow> rows = relocalization_rows(out / "relocalization.csv");
  ASSERT_EQ(rows.size(), 30U);
  std::size_t answered = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RelocalizationRow& row = rows[i];
    EXPECT_EQ(row.scan, i);
    EXPECT_NEAR(row.stamp_s, 0.1 * static_cast<double>(i), 1e-6);
    EXPECT_EQ(row.covariance.has_value(), row.answered) << "as the pose";
    if (row.answered) {
      ++answered;
      EXPECT_LT(error_m(row), 0.3) << "scan " << i;
      EXPECT_GE(row.p_correct, 0.5);
      EXPECT_GT(row.covariance->diagonal().minCoeff(), 0.0);
    } else {
      EXPECT_NE(row.reason, "") << "scan " << i;
    }
  }
  EXPECT_GE(answered, 25U) << storage::read_file(out / "relocalization.csv");
  EXPECT_EQ(rows.back().state, "tracking");

  const io::Trajectory tum = io::read_trajectory(out / "trajectory.tum");
  ASSERT_EQ(tum.poses.size(), answered);
  EXPECT_LT(pose_error(tum.poses.back(), rows.back().T_map_lidar).translation_m, 1e-6);
  const nlohmann::json all = summary(out);
  EXPECT_EQ(all["scans"], 30);
  EXPECT_EQ(all["answered"], answered);
  EXPECT_EQ(all["judged"], answered);
  EXPECT_EQ(all["wrong"], 0);
  EXPECT_LT(all["median_error_m"], 0.1);
  EXPECT_EQ(all["losses"], 0);
  EXPECT_TRUE(fs::exists(out / "timings.json"));
  EXPECT_THAT(result.output, HasSubstr("0 of " + std::to_string(answered) + " answers wrong"));
}

TEST_F(Relocalize, AJumpIsNoticedAndThePlaceIsFoundAgain) {
  const fs::path log = day2("jump", 90);
  cut_out(log, 15, 70, 4.0);
  const fs::path out = fresh("jump_out");
  const ProgramResult result = relocalize(log, out, {"--map-truth", day1() / "poses.txt"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::vector<RelocalizationRow> rows = relocalization_rows(out / "relocalization.csv");
  ASSERT_EQ(rows.size(), 35U);
  EXPECT_EQ(rows[14].state, "tracking");
  EXPECT_TRUE(rows[15].given_up) << storage::read_file(out / "relocalization.csv");
  EXPECT_EQ(rows[15].answered, rows[15].state == "tracking") << "lost, or found again with the same scan";
  EXPECT_EQ(rows.back().state, "tracking") << "found again";
  const nlohmann::json all = summary(out);
  EXPECT_EQ(all["losses"], 1);
  EXPECT_EQ(all["recoveries"], 1);
  EXPECT_EQ(all["wrong"], 0);
}

TEST_F(Relocalize, AForeignLogGetsNoPose) {
  testing_support::write_passing_log(scratch("foreign"), 0.0, 3000, 5, 77);
  const fs::path out = fresh("foreign_out");
  const ProgramResult result = relocalize(scratch("foreign"), out);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  for (const RelocalizationRow& row : relocalization_rows(out / "relocalization.csv")) {
    EXPECT_EQ(row.state, "searching") << "scan " << row.scan;
    EXPECT_FALSE(row.answered) << "scan " << row.scan;
    EXPECT_LT(row.p_correct, 0.5) << "scan " << row.scan;
    EXPECT_NE(row.reason, "") << "scan " << row.scan;
  }
  const nlohmann::json all = summary(out);
  EXPECT_EQ(all["scans"], 5);
  EXPECT_EQ(all["answered"], 0);
  EXPECT_LT(all["first_answer_s"], 0.0);
  EXPECT_FALSE(all.contains("judged"));
  EXPECT_THAT(result.output, HasSubstr("first answer none"));
}

TEST_F(Relocalize, ScansOnTheirOwnDoNotKnowTheOnesBefore) {
  const fs::path log = day2("single", 30);
  const fs::path some = fresh("some_out");
  ASSERT_EQ(relocalize(log, some, {"--single", "--every", "14"}).exit_code, 0);
  const auto rows = relocalization_rows(some / "relocalization.csv");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].scan, 14U);
  cut_out(log, 0, 28, 0.0);
  const fs::path last = fresh("last_out");
  ASSERT_EQ(relocalize(log, last, {"--single", "--every", "2"}).exit_code, 0);
  const auto alone = relocalization_rows(last / "relocalization.csv");
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0].answered, rows[2].answered);
  EXPECT_EQ(alone[0].p_correct, rows[2].p_correct);
  EXPECT_EQ(alone[0].T_map_lidar.matrix(), rows[2].T_map_lidar.matrix());
}

TEST_F(Relocalize, ADamagedScanIsToldAndTheRestIsPlaced) {
  const fs::path log = day2("damaged", 12);
  std::ofstream(log / "000009.pcd") << "no scan\n";
  const fs::path out = fresh("damaged_out");
  const ProgramResult result = relocalize(log, out);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto rows = relocalization_rows(out / "relocalization.csv");
  ASSERT_EQ(rows.size(), 12U);
  EXPECT_FALSE(rows[9].answered);
  EXPECT_THAT(rows[9].reason, HasSubstr("000009.pcd"));
  EXPECT_TRUE(rows[11].answered) << rows[11].reason;
  EXPECT_LT(error_m(rows[11]), 0.3);
}

TEST_F(Relocalize, BadInputIsRefusedAndNothingIsLeft) {
  const fs::path log = day2("short", 4);
  const auto told = [&](const std::vector<std::string>& words, const std::string& problem) {
    const fs::path out = fresh("bad");
    std::vector<std::string> all = {"relocalize"};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), {"-o", out, "-q"});
    const ProgramResult result = run_program(all);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr(problem));
    EXPECT_FALSE(fs::exists(out));
    EXPECT_FALSE(fs::exists(out.string() + ".partial"));
  };
  const std::string run = scratch("run");
  fs::create_directories(scratch("empty"));
  told({scratch("nowhere"), log}, "there is no run");
  told({log, log}, "there is no run");
  told({run, scratch("nowhere")}, "no such file or folder");
  told({run, scratch("empty")}, scratch("empty").string());
  told({run, log, "--map-truth", log / "poses.txt"}, "4 poses for 110 scans");
  told({run, log, "--map-truth", day1() / "poses.txt", "--truth", day1() / "poses.txt"}, "110 poses for 4 scans");
  told({run, log, "--every", "0"}, "--every");
  told({run, log, "--set", "relocalization.places=0"}, "places");
  told({run}, "LOG");
  fs::remove(log / "poses.txt");
  told({run, log, "--map-truth", day1() / "poses.txt"}, "--truth");

  const fs::path there = fresh("there");
  fs::create_directories(there);
  const ProgramResult taken = relocalize(log, there);
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.output, HasSubstr("never overwritten"));
  EXPECT_TRUE(fs::is_empty(there));
}

}  // namespace
}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark map as a user runs it, on a short drive through a synthetic street.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "app/sweep_logs.hpp"
#include "loopmark/mapping/trajectory_metrics.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using testing_support::expect_same_products;
using testing_support::kMapProducts;
using testing_support::ProgramResult;
using testing_support::RunningProgram;

constexpr int kScans = testing_support::StreetLogs::kScans;
const testing_support::StreetLogs kLogs{"map_test"};

fs::path scratch(const std::string& name) { return kLogs.scratch(name); }
fs::path make_log(const std::string& name) { return kLogs.make_log(name); }
fs::path new_run(const std::string& name) { return kLogs.new_run(name); }

ProgramResult map(const fs::path& log, const fs::path& run, const std::vector<std::string>& more = {}) {
  return RunningProgram(testing_support::map_words(log, run, more)).wait();
}

TEST(Map, LeavesAWholeRunAndNeverOverwritesIt) {
  const fs::path log = make_log("log");
  const fs::path run = new_run("whole");
  const ProgramResult result = map(log, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_FALSE(fs::exists(run.string() + ".partial"));
  for (const char* const product : kMapProducts) {
    EXPECT_TRUE(fs::exists(run / product)) << product;
  }
  EXPECT_TRUE(fs::exists(run / "manifest.json"));
  EXPECT_TRUE(fs::exists(run / "report.html"));
  const std::vector<Pose> found = io::read_trajectory(run / "trajectory.tum").poses;
  ASSERT_EQ(found.size(), static_cast<std::size_t>(kScans));
  EXPECT_LT(mapping::absolute_error(found, io::read_trajectory(log / "poses.txt").poses).rmse_m, 0.1);
  EXPECT_THAT(result.output, testing::HasSubstr("ATE"));

  const ProgramResult again = map(log, run);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.output, testing::HasSubstr("never overwritten"));
}

TEST(Map, TheSameBytesWithOneAndTwoThreads) {
  const fs::path log = make_log("log_threads");
  const fs::path one = new_run("one");
  const fs::path two = new_run("two");
  ASSERT_EQ(map(log, one, {"--threads", "1"}).exit_code, 0);
  ASSERT_EQ(map(log, two, {"--threads", "2"}).exit_code, 0);
  expect_same_products(one, two);
}

TEST(Map, AKilledRunResumesToTheSameBytes) {
  const fs::path log = make_log("log_killed");
  const fs::path expected = new_run("not_killed");
  ASSERT_EQ(map(log, expected).exit_code, 0);
  for (const int signal : {SIGINT, SIGKILL}) {
    const fs::path run = new_run("killed" + std::to_string(signal));
    RunningProgram program(testing_support::map_words(log, run));
    const fs::path records = run.string() + ".partial/records/scans.rec";
    for (int i = 0; i < 6000 && (!fs::exists(records) || fs::file_size(records) < 4000); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    program.send(signal);
    EXPECT_EQ(program.wait().exit_code, signal == SIGINT ? 130 : 128 + SIGKILL);
    ASSERT_FALSE(fs::exists(run));
    EXPECT_EQ(map(log, run).exit_code, 2) << "a partial run is not overwritten";
    const ProgramResult resumed = RunningProgram({"map", "--resume", run, "-q"}).wait();
    ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
    expect_same_products(expected, run);
  }
}

TEST(Map, SkipsDamagedScansUpToALimit) {
  const fs::path log = make_log("log_damaged");
  fs::resize_file(log / "000005.pcd", 0);
  fs::resize_file(log / "000011.pcd", 3000);
  const fs::path run = new_run("damaged");
  const ProgramResult result = map(log, run);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, testing::HasSubstr("2 damaged"));
  EXPECT_EQ(io::read_trajectory(run / "trajectory.tum").poses.size(), static_cast<std::size_t>(kScans));
  EXPECT_LT(mapping::absolute_error(io::read_trajectory(run / "trajectory.tum").poses,
                                    io::read_trajectory(log / "poses.txt").poses)
                .max_m,
            0.3);

  const ProgramResult strict = map(log, new_run("strict"), {"--set", "slam.max_bad_scans=1"});
  EXPECT_EQ(strict.exit_code, 2);
  EXPECT_THAT(strict.output, testing::AllOf(testing::HasSubstr("max_bad_scans"), testing::HasSubstr("000011.pcd")));
}

TEST(Map, SaysWhatIsWrongWithItsArguments) {
  const fs::path log = make_log("log_arguments");
  EXPECT_EQ(map(scratch("nowhere"), new_run("a")).exit_code, 2);
  const fs::path empty = scratch("empty");
  fs::create_directories(empty);
  EXPECT_EQ(map(empty, new_run("b")).exit_code, 2);
  EXPECT_EQ(map(log, "/proc/no/such/place").exit_code, 2);
  EXPECT_EQ(RunningProgram({"map", "--resume", new_run("c")}).wait().exit_code, 2);
  EXPECT_EQ(RunningProgram({"map", log}).wait().exit_code, 2);
  const fs::path truth = scratch("truth.txt");
  io::write_kitti(truth, {Pose::Identity(), Pose::Identity()});
  const ProgramResult wrong = map(log, new_run("d"), {"--truth", truth});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, testing::HasSubstr("2 poses for 24 scans"));
}

}  // namespace
}  // namespace loopmark::app

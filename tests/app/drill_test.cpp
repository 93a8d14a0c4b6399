// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark drill as a user runs it, on a short drive through a synthetic street.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "loopmark/storage/files.hpp"
#include "passing_log.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using testing_support::ProgramResult;
using testing_support::run_program;

/// Below a folder of this process alone: tests run side by side.
fs::path scratch(const std::string& name) {
  return fs::path(testing::TempDir()) / ("loopmark_drill_" + std::to_string(::getpid())) / name;
}

fs::path make_log(const std::string& name, double offset_m, std::uint64_t noise) {
  const fs::path log = scratch(name);
  testing_support::write_passing_log(log, offset_m, noise);
  return log;
}

class Drill : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::create_directories(scratch("").parent_path());
    log_of_day = make_log("log", 0.0, 0);
    run_of_day = fresh("run");
    const ProgramResult mapped =
        run_program({"map", log_of_day, "-o", run_of_day, "-q", "--set", testing_support::kPassingLogSetting});
    ASSERT_EQ(mapped.exit_code, 0) << mapped.output;
    const auto summary = nlohmann::json::parse(storage::read_file(run_of_day / "summary.json"));
    ASSERT_LT(summary["ate_rmse_m"], 0.1) << "the map itself";
  }

  static void TearDownTestSuite() { fs::remove_all(scratch("").parent_path()); }

  static fs::path fresh(const std::string& name) {
    const fs::path path = scratch(name);
    fs::remove_all(path);
    fs::remove_all(path.string() + ".partial");
    return path;
  }

  static ProgramResult drill(const fs::path& what, const fs::path& output, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"drill", what, "-o", output, "-q", "--set", "drill.outages_s=[0.5,1]"};
    if (std::find(more.begin(), more.end(), "--events") == more.end()) {
      words.insert(words.end(), {"--events", "6"});
    }
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }

  static inline fs::path log_of_day;
  static inline fs::path run_of_day;
};

TEST_F(Drill, ReportsEveryEventAndNoneIsWrong) {
  const fs::path out = fresh("out");
  const ProgramResult result = drill(run_of_day, out);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, testing::HasSubstr("teleport"));
  const auto summary = nlohmann::json::parse(storage::read_file(out / "summary.json"));
  EXPECT_EQ(summary["events"], 6);
  EXPECT_EQ(summary["by"]["all"]["wrong"], 0) << storage::read_file(out / "drill.csv");
  EXPECT_GE(summary["by"]["all"]["in_time"], 5) << storage::read_file(out / "drill.csv");
  const std::string csv = storage::read_file(out / "drill.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_THAT(storage::read_file(out / "report.html"), testing::HasSubstr("Where tracking was cut"));
  EXPECT_FALSE(fs::exists(out.string() + ".partial"));
}

TEST_F(Drill, ASeedRepeatsItByteForByteAtAnyNumberOfThreads) {
  const fs::path one = fresh("one");
  const fs::path two = fresh("two");
  const fs::path other = fresh("other");
  ASSERT_EQ(drill(run_of_day, one, {"--seed", "3", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(drill(run_of_day, two, {"--seed", "3", "--threads", "2"}).exit_code, 0);
  for (const char* const file : {"drill.csv", "summary.json", "report.html", "config.yaml"}) {
    EXPECT_EQ(storage::sha256_of_file(one / file), storage::sha256_of_file(two / file)) << file;
  }
  ASSERT_EQ(drill(run_of_day, other, {"--seed", "4"}).exit_code, 0);
  EXPECT_NE(storage::sha256_of_file(one / "drill.csv"), storage::sha256_of_file(other / "drill.csv"));
}

TEST_F(Drill, EventsThatAreChosenAreTheSameAlone) {
  const fs::path all = fresh("all");
  const fs::path some = fresh("some");
  ASSERT_EQ(drill(run_of_day, all).exit_code, 0);
  ASSERT_EQ(drill(run_of_day, some, {"--only", "4,1"}).exit_code, 0);
  const auto rows = [](const fs::path& folder) {
    std::istringstream lines(storage::read_file(folder / "drill.csv"));
    std::vector<std::string> found;
    for (std::string line; std::getline(lines, line);) {
      found.push_back(line);
    }
    return found;
  };
  const std::vector<std::string> every = rows(all);
  ASSERT_EQ(every.size(), 7U);
  EXPECT_THAT(rows(some), testing::ElementsAre(every[0], every[5], every[2]));
}

TEST_F(Drill, GoesOnInAnotherDriveWhoseTruthIsKnown) {
  const fs::path drive = make_log("drive", 1.5, 1000);
  const fs::path out = fresh("with_drive");
  const ProgramResult result =
      drill(run_of_day, out, {"--drive", drive, "--events", "2", "--set", "drill.disturbances=[other-drive]"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto summary = nlohmann::json::parse(storage::read_file(out / "summary.json"));
  EXPECT_EQ(summary["by"]["other-drive"]["events"], 2);
  EXPECT_EQ(summary["by"]["other-drive"]["wrong"], 0) << storage::read_file(out / "drill.csv");

  fs::remove(drive / "poses.txt");
  const ProgramResult refused = drill(run_of_day, fresh("refused"), {"--drive", drive});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output, testing::HasSubstr("--truth"));
}

TEST_F(Drill, MapsALogFirst) {
  const fs::path out = fresh("from_log");
  const ProgramResult result = drill(
      log_of_day, out, {"--events", "2", "--set", testing_support::kPassingLogSetting, "--set", "drill.limit_s=5"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(fs::exists(out / "map" / "trajectory.tum"));
  EXPECT_TRUE(fs::exists(out / "report.html"));
}

TEST_F(Drill, BadInputIsRefusedAndNothingIsLeft) {
  const auto expect_refusal = [&](const fs::path& what, std::vector<std::string> more, const std::string& says) {
    const fs::path out = fresh("bad");
    const ProgramResult result = drill(what, out, std::move(more));
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, testing::HasSubstr(says));
    EXPECT_FALSE(fs::exists(out));
    EXPECT_FALSE(fs::exists(out.string() + ".partial"));
  };
  expect_refusal(scratch("nowhere"), {}, "is not there");
  expect_refusal(run_of_day, {"--events", "0"}, "--events");
  expect_refusal(run_of_day, {"--set", "drill.outages_s=[-1]"}, "outages_s");
  expect_refusal(run_of_day, {"--set", "drill.disturbances=[flood]"}, "flood");
  expect_refusal(run_of_day, {"--set", "drill.disturbances=[other-drive]"}, "too short");
  expect_refusal(run_of_day, {"--truth", log_of_day / "poses.txt"}, "--drive");
  expect_refusal(run_of_day, {"--only", "6"}, "no event 6");
  expect_refusal(run_of_day, {"--within", "20"}, "limit_s");
  expect_refusal(run_of_day, {"--log", make_log("short", 0.0, 7).parent_path() / "nowhere"}, "is not there");
  const fs::path there = fresh("there");
  fs::create_directories(there);
  EXPECT_EQ(drill(run_of_day, there).exit_code, 2);
  EXPECT_TRUE(fs::is_empty(there));
}

TEST_F(Drill, ARunWhoseLogIsGoneSaysHowToNameIt) {
  const fs::path log = make_log("moving", 0.0, 50);
  const fs::path run = fresh("moved_run");
  ASSERT_EQ(run_program({"map", log, "-o", run, "-q", "--set", testing_support::kPassingLogSetting}).exit_code, 0);
  const fs::path elsewhere = fresh("moved");
  fs::rename(log, elsewhere);
  const ProgramResult result = drill(run, fresh("gone"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, testing::HasSubstr("--log LOG"));
  fs::remove(elsewhere / "000109.pcd");
  const ProgramResult other = drill(run, fresh("gone"), {"--log", elsewhere});
  EXPECT_EQ(other.exit_code, 2);
}

}  // namespace
}  // namespace loopmark::app

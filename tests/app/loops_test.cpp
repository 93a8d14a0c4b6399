// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark loops as a program, on a run whose truth is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "loopmark/map_store/loop_decisions.hpp"
#include "support/run_program.hpp"
#include "synthetic_run.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_support::ProgramResult;
using testing_support::run_program;

class LoopsCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    original_ = fs::path(::testing::TempDir()) / ("loopmark_loops_" + std::to_string(::getpid()));
    fs::remove_all(original_);
    fs::create_directories(original_);
    made_ = std::make_unique<testing_support::SyntheticRun>(original_ / "made");
  }
  static void TearDownTestSuite() { fs::remove_all(original_); }

  void SetUp() override {
    folder_ = original_ / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
    run_ = folder_ / "run";
    fs::copy(original_ / "made", run_, fs::copy_options::recursive);
  }

  static std::string pair(std::size_t i, std::size_t j) {
    return std::to_string(made_->scan_of_keyframe[i]) + "-" + std::to_string(made_->scan_of_keyframe[j]);
  }
  static double ate_m(const fs::path& run) {
    return nlohmann::json::parse(storage::read_file(run / "summary.json")).at("ate_rmse_m").get<double>();
  }

  static inline fs::path original_;
  static inline std::unique_ptr<testing_support::SyntheticRun> made_;
  fs::path folder_;
  fs::path run_;
};

TEST_F(LoopsCommand, ListsEveryCandidateWithItsVerdict) {
  const ProgramResult result = run_program({"loops", run_.string()});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("k39-k0"));
  EXPECT_THAT(result.output, HasSubstr("rejected: two answers are alike"));
  EXPECT_THAT(result.output, HasSubstr("3 accepted of 5 candidates, 0 decided by a person"));
}

TEST_F(LoopsCommand, AVetoSolvesAgainAndKeepsTheOldRun) {
  const std::string before = storage::read_file(run_ / "manifest.json");
  const ProgramResult result = run_program({"loops", run_.string(), "--veto", pair(39, 0), "--veto", "k3-k36"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("rejected: vetoed by a person"));
  EXPECT_THAT(result.output, HasSubstr("2 decided by a person"));
  EXPECT_EQ(storage::read_file(fs::path(run_.string() + ".before-1") / "manifest.json"), before);
  EXPECT_TRUE(fs::exists(fs::path(run_.string() + ".before-1") / "cloud.ply"));
  EXPECT_FALSE(fs::exists(run_ / "cloud.ply")) << "shows the old poses";
  EXPECT_FALSE(fs::exists(run_.string() + ".partial"));
  EXPECT_THAT(storage::read_file(run_ / "loops.csv"), HasSubstr("vetoed by a person"));
  for (const char* file : {"trajectory.tum", "pose_graph.g2o", "covariances.csv", "report.html"}) {
    EXPECT_TRUE(fs::exists(run_ / file)) << file;
  }
  EXPECT_THAT(run_program({"loops", run_.string()}).output, HasSubstr("rejected: vetoed by a person"));
}

TEST_F(LoopsCommand, ForcingAWrongLoopBendsTheMapAndForgettingMendsIt) {
  ASSERT_EQ(run_program({"loops", run_.string(), "-o", (folder_ / "plain").string()}).exit_code, 0);
  ASSERT_EQ(
      run_program({"loops", run_.string(), "--force", pair(30, 8), "-o", (folder_ / "forced").string()}).exit_code, 0);
  EXPECT_GT(ate_m(folder_ / "forced"), 3.0 * ate_m(folder_ / "plain"));
  EXPECT_THAT(storage::read_file(folder_ / "forced/loops.csv"), HasSubstr("forced by a person"));
  const ProgramResult back = run_program({"loops", (folder_ / "forced").string(), "--forget", pair(8, 30)});
  EXPECT_EQ(back.exit_code, 0) << back.output;
  EXPECT_EQ(storage::read_file(folder_ / "forced/trajectory.tum"),
            storage::read_file(folder_ / "plain/trajectory.tum"));
  EXPECT_EQ(storage::read_file(folder_ / "forced/loops.csv"), storage::read_file(folder_ / "plain/loops.csv"));
}

TEST_F(LoopsCommand, AForcedPairThatWasNoCandidateIsRegisteredNow) {
  const ProgramResult result = run_program({"loops", run_.string(), "--force", "k35-k4"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("accepted: forced by a person"));
  EXPECT_EQ(run_program({"loops", run_.string(), "--forget", "k35-k4"}).exit_code, 0);
  EXPECT_THAT(run_program({"loops", run_.string()}).output, Not(HasSubstr("k35-k4")));
}

TEST_F(LoopsCommand, MapsAreMadeAnewWhenAskedFor) {
  const ProgramResult result = run_program({"loops", run_.string(), "--maps", "-o", (folder_ / "new").string()});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* file : {"cloud.ply", "map.bt", "map.simplemap"}) {
    EXPECT_TRUE(fs::exists(folder_ / "new" / file)) << file;
  }
}

TEST_F(LoopsCommand, WrongInputIsToldAndChangesNothing) {
  const std::string before = storage::read_file(run_ / "manifest.json");
  const auto told = [&](std::vector<std::string> words, const std::string& problem) {
    words.insert(words.begin(), "loops");
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr(problem));
  };
  told({"/nowhere/run"}, "there is no run");
  told({run_.string(), "--veto", "k30-k7"}, "is no loop candidate, so there is nothing to veto");
  told({run_.string(), "--veto", "k30-k7"}, "the nearest candidate is " + pair(30, 8));
  told({run_.string(), "--veto", "k300-k3"}, "there is no such keyframe");
  told({run_.string(), "--veto", "5000-3"}, "there is no such scan");
  told({run_.string(), "--veto", "5-0"}, "is no keyframe");
  told({run_.string(), "--veto", "five"}, "is no pair of scans");
  told({run_.string(), "--veto", "k3-k3"}, "a loop joins two keyframes");
  told({run_.string(), "--veto", "k30-k8", "--force", "k8-k30"}, "is named twice");
  told({run_.string(), "--forget", "k30-k8"}, "nobody has decided");
  told({run_.string(), "--set", "odometry.max_range_m=3"}, "needs loopmark map again");
  told({run_.string(), "--veto", "k30-k8", "-o", run_.string()}, "never overwritten");
  EXPECT_EQ(storage::read_file(run_ / "manifest.json"), before);
  EXPECT_FALSE(fs::exists(run_.string() + ".partial"));
}

}  // namespace
}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark why as a program, on a run whose truth is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/run_program.hpp"
#include "synthetic_run.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing_support::ProgramResult;
using testing_support::run_program;

class WhyCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(::testing::TempDir()) / ("loopmark_why_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    made_ = std::make_unique<testing_support::SyntheticRun>(run());
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  static fs::path run() { return folder_ / "run"; }

  static std::string told(const std::string& i, const std::string& j) {
    const ProgramResult result = run_program({"why", run().string(), i, j});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
  }

  static inline fs::path folder_;
  static inline std::unique_ptr<testing_support::SyntheticRun> made_;
};

TEST_F(WhyCommand, AnAcceptedLoopFromEitherSide) {
  const std::string text = told("k39", "k0");
  EXPECT_THAT(text, AllOf(HasSubstr("proposed    yes, by: place"), HasSubstr("on record"), HasSubstr("mode 1"),
                          HasSubstr("agrees with 2 of the 3 other loops"), HasSubstr("verdict       accepted\n")));
  EXPECT_EQ(told("k0", "k39"), text);
  EXPECT_EQ(told(std::to_string(made_->scan_of_keyframe[39]), "0"), text);
}

TEST_F(WhyCommand, AWrongLoopIsInconsistent) {
  EXPECT_THAT(told("k30", "k8"), AllOf(HasSubstr("pose graph  inconsistent: weight 0.00"),
                                       HasSubstr("verdict       rejected: inconsistent")));
}

TEST_F(WhyCommand, AnUnansweredOneTookNoPart) {
  EXPECT_THAT(told("k28", "k11"), AllOf(HasSubstr("no answer: two answers are alike"), HasSubstr("took no part"),
                                        HasSubstr("verdict       rejected: two answers are alike")));
}

TEST_F(WhyCommand, WhatWasNoCandidateIsRegisteredNow) {
  EXPECT_THAT(told("k35", "k4"),
              AllOf(HasSubstr("no place was looked up"), HasSubstr("not when the map was made; now:"),
                    HasSubstr("verdict       never a candidate")));
  EXPECT_THAT(told("k39", "k5"), HasSubstr("not among the 2 most alike places"));
  EXPECT_THAT(told("k20", "k19"), HasSubstr("no: only"));
}

TEST_F(WhyCommand, AScanThatIsNoKeyframeStandsForTheOneBefore) { EXPECT_EQ(told("5", "k39"), told("k4", "k39")); }

TEST_F(WhyCommand, DrawsThePair) {
  const fs::path picture = folder_ / "pair.png";
  EXPECT_EQ(run_program({"why", run().string(), "k39", "k0", "--picture", picture.string()}).exit_code, 0);
  EXPECT_EQ(storage::read_file(picture).substr(1, 3), "PNG");
}

TEST_F(WhyCommand, WrongInputIsTold) {
  const auto wrong = [&](std::vector<std::string> words, const std::string& problem) {
    words.insert(words.begin(), "why");
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr(problem));
  };
  wrong({"/nowhere/run", "1", "2"}, "there is no run");
  wrong({run().string(), "1", "9999"}, "there is no such scan");
  wrong({run().string(), "k1", "k40"}, "there is no such keyframe");
  wrong({run().string(), "4", "5"}, "stand for the same keyframe");
  wrong({run().string(), "one", "5"}, "names no scan");
  wrong({run().string(), "1", "9", "--picture", "/nowhere/at/all.png"}, "/nowhere/at/all.png");
}

}  // namespace
}  // namespace loopmark::app

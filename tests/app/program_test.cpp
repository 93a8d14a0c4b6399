// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The program as a whole: exit codes, help, options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "command.hpp"
#include "commit.hpp"
#include "loopmark/core/version.hpp"
#include "loopmark/storage/files.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

using testing::HasSubstr;
using testing_support::ProgramResult;
using testing_support::run_program;

TEST(Program, HelpAndVersionSucceed) {
  const ProgramResult help = run_program({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const Command& command : commands()) {
    EXPECT_THAT(help.output, HasSubstr(command.name));
    EXPECT_THAT(help.output, HasSubstr(command.summary));
  }
  const ProgramResult version_line = run_program({"--version"});
  EXPECT_EQ(version_line.exit_code, 0);
  EXPECT_EQ(version_line.output, "loopmark " + version_text() + "\n");
  EXPECT_THAT(version_line.output, testing::StartsWith(std::string("loopmark ") + version()));
}

TEST(Program, HelpOfEachSubcommandHasExamples) {
  for (const Command& command : commands()) {
    const ProgramResult help = run_program({command.name, "--help"});
    EXPECT_EQ(help.exit_code, 0) << command.name;
    EXPECT_THAT(help.output, HasSubstr("Example")) << command.name;
    EXPECT_THAT(help.output, HasSubstr(std::string("loopmark ") + command.name)) << command.name;
  }
}

TEST(Program, WrongUsageIsExitCode2) {
  const std::vector<std::vector<std::string>> wrong = {
      {}, {"no-such-command"}, {"config"}, {"config", "dump", "--no-such-option"}, {"config", "check"}};
  for (const auto& arguments : wrong) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(arguments) << result.output;
    EXPECT_FALSE(result.output.empty()) << testing::PrintToString(arguments);
  }
}

TEST(Program, UnknownWordsAreAnsweredWithTheNearest) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> answers = {
      {{"mapp"}, "error: there is no command 'mapp': did you mean 'map'? (see: loopmark --help)"},
      {{"relocalise"}, "did you mean 'relocalize'?"},
      {{"align", "a.bin", "b.bin"}, "did you mean 'register'?"},
      {{"show"}, "did you mean 'view'?"},
      {{"qqqqqqq"}, "there are doctor, map, merge"},
      {{"config", "dmp"}, "did you mean 'dump'? (see: loopmark config --help)"},
      {{"map", "drive", "--outptu", "run"}, "there is no option '--outptu': did you mean '--output'?"},
      {{"relocalize", "run", "drive", "-o", "out", "--thread=2"}, "did you mean '--threads'?"},
      {{"register", "a.bin", "b.bin", "c.bin"}, "'c.bin' was not expected (see: loopmark register --help)"}};
  for (const auto& [arguments, answer] : answers) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_THAT(result.output, HasSubstr(answer)) << testing::PrintToString(arguments);
  }
}

TEST(Program, WrongInputIsExitCode2AndOneLine) {
  const ProgramResult result = run_program({"config", "check", "/nowhere/at-all.yaml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("error: /nowhere/at-all.yaml"));
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
}

TEST(ProgramOptions, DefaultFileIsTheDumpOfTheDefaults) {
  EXPECT_EQ(storage::read_file(LOOPMARK_SOURCE_DIR "/config/default.yaml"),
            workflows::options_as_yaml(workflows::ProgramOptions()))
      << "run: loopmark config dump -o config/default.yaml";
}

TEST(ProgramOptions, DumpIsCheckedAsFine) {
  const std::string file = testing::TempDir() + "loopmark_program_test.yaml";
  EXPECT_EQ(run_program({"config", "dump", "-o", file, "--set", "registration.hypotheses=7"}).exit_code, 0);
  EXPECT_THAT(storage::read_file(file), HasSubstr("hypotheses: 7 "));
  const ProgramResult check = run_program({"config", "check", file});
  EXPECT_EQ(check.exit_code, 0) << check.output;
  const ProgramResult again = run_program({"--config", file, "config", "dump"});
  EXPECT_EQ(again.output, storage::read_file(file));
}

TEST(ProgramOptions, UnknownKeyNamesFileLineAndTheNearest) {
  const std::string file = testing::TempDir() + "loopmark_program_wrong_test.yaml";
  std::ofstream(file) << "registration:\n  hypotheces: 7\n";
  const ProgramResult result = run_program({"config", "dump", "--config", file});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr(file + ":2: unknown option 'registration.hypotheces'"));
  EXPECT_THAT(result.output, HasSubstr("did you mean 'registration.hypotheses'?"));
  EXPECT_EQ(run_program({"config", "dump", "--set", "registration.hypotheses=x"}).exit_code, 2);
}

}  // namespace
}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C during work: exit code 130, no output under its final name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

using testing_support::ProgramResult;
using testing_support::RunningProgram;

/// Whether `path` comes into being within a minute.
bool appears(const std::filesystem::path& path) {
  for (int i = 0; i < 6000 && !std::filesystem::exists(path); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::filesystem::exists(path);
}

class Interrupt : public testing::TestWithParam<int> {};

TEST_P(Interrupt, OfASimulationLeavesNoFinishedLog) {
  const std::filesystem::path folder = testing::TempDir() + "loopmark_interrupt_test" + std::to_string(GetParam());
  std::filesystem::remove_all(folder);
  std::filesystem::remove_all(folder.string() + ".partial");
  RunningProgram program({"simulate", "-o", folder, "--length", "2000", "--sensor", "vlp16"});
  ASSERT_TRUE(appears(folder.string() + ".partial"));
  program.send(GetParam());
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130) << result.output;
  EXPECT_THAT(result.output, testing::HasSubstr("interrupted: " + folder.string() + ".partial is not whole"));
  EXPECT_FALSE(std::filesystem::exists(folder));
  std::filesystem::remove_all(folder.string() + ".partial");
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "io/io_fixtures.hpp"
#include "loopmark/io/point_files.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

using loopmark::testing::random_cloud;
using loopmark::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing_support::ProgramResult;
using testing_support::run_program;

TEST(Doctor, ReportsALogInWordsAndAsJson) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i) {
    io::write_pcd(folder / (std::to_string(i) + ".pcd"), random_cloud(100, static_cast<std::uint64_t>(i)));
  }
  const ProgramResult text = run_program({"doctor", folder.path().string(), "--set", "log.rate_hz=5"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.output, HasSubstr("folder-pcd"));
  EXPECT_THAT(text.output, HasSubstr("5 Hz"));
  const ProgramResult json = run_program({"doctor", folder.path().string(), "--json"});
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_THAT(json.output, HasSubstr("\"usable\": 3"));
}

TEST(Doctor, ReportsADataSet) {
  const TemporaryFolder folder;
  for (const char* name : {"one", "two"}) {
    std::filesystem::create_directories(folder.path() / name / "velodyne");
    io::write_bin(folder.path() / name / "velodyne" / "000000.bin", random_cloud(100));
  }
  const ProgramResult result = run_program({"doctor", folder.path().string()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("2 drives usable"));
}

TEST(Doctor, WhatIsNoLogIsAnInputError) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program({"doctor", (folder / "missing").string()}).exit_code, 2);
  EXPECT_EQ(run_program({"doctor", folder.path().string()}).exit_code, 2);
  folder.write("notes.txt", "x");
  const ProgramResult result = run_program({"doctor", folder.path().string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("no drive log"));
  folder.write("000000.bin", "");
  EXPECT_EQ(run_program({"doctor", folder.path().string()}).exit_code, 2);
}

}  // namespace
}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What names, terminals, disks and signals can do to the whole program.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_support::ProgramResult;
using testing_support::run_program;
using testing_support::RunningProgram;

class HostileNames : public ::testing::Test {
 protected:
  HostileNames() : root_(storage::make_private_folder(::testing::TempDir(), "loopmark_names_")) {}
  ~HostileNames() override {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }

  /// A simulated log of some scans in a folder of this name.
  fs::path log(const std::string& name) const {
    const ProgramResult made =
        run_program({"simulate", "--length", "12", "--sensor", "vlp16", "-o", (root_ / "log").string(), "-q"});
    EXPECT_EQ(made.exit_code, 0) << made.output;
    fs::rename(root_ / "log", root_ / name);
    return root_ / name;
  }

  fs::path root_;
};

TEST_F(HostileNames, ALogWhoseNameIsNoUtf8IsMappedAndResumed) {
  const fs::path named = log("latin-\xe4");
  const std::string run = (root_ / "run-\xe4").string();
  const ProgramResult mapped = run_program({"map", named.string(), "-o", run, "-q"});
  EXPECT_EQ(mapped.exit_code, 0) << mapped.output;
  EXPECT_THAT(mapped.output, HasSubstr("run-\\xe4"));
  fs::rename(run, run + ".partial");
  fs::remove(run + ".partial/manifest.json");
  const ProgramResult resumed = run_program({"map", "--resume", run, "-q"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
}

TEST_F(HostileNames, EscapeSequencesInNamesDoNotReachTheTerminal) {
  const std::string named = log("a\x1b]0;pwned\x07\x1b[31m").string();
  for (const ProgramResult& result : {run_program({"doctor", named}), run_program({"doctor", named + "\x1b[2J"})}) {
    EXPECT_THAT(result.output, Not(HasSubstr("\x1b")));
    EXPECT_THAT(result.output, HasSubstr("\\x1b"));
  }
}

TEST_F(HostileNames, OutputThatIsLostIsAnError) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full";
  }
  RunningProgram program({"config", "dump"}, LOOPMARK_BINARY,
                         [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("standard output: cannot write: No space left"));
}

TEST(ExitCodes, WhatTheSystemRefusesIsNoDefect) {
  EXPECT_EQ(exit_code_of(std::bad_alloc()), ExitCode::kInput);
  EXPECT_EQ(exit_code_of(std::system_error(EAGAIN, std::generic_category())), ExitCode::kInput);
  EXPECT_EQ(exit_code_of(fs::filesystem_error("x", std::make_error_code(std::errc::read_only_file_system))),
            ExitCode::kInput);
  EXPECT_EQ(exit_code_of(std::logic_error("x")), ExitCode::kInternal);
}

}  // namespace
}  // namespace loopmark::app

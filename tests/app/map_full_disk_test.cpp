// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A disk that gets full at any place of a run: the file is named, nothing is half written, and once there is room the
// run goes on to the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include "app/sweep_logs.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing_support::ProgramResult;
using testing_support::RunningProgram;

const testing_support::StreetLogs kLogs{"map_full_disk_test"};

/// A log and the run that a disk with room gives.
struct Whole {
  fs::path log;
  fs::path run;
};

const Whole& whole() {
  static const Whole kWhole = [] {
    const Whole made{kLogs.make_log("log"), kLogs.new_run("whole")};
    const ProgramResult result = RunningProgram(testing_support::map_words(made.log, made.run)).wait();
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return made;
  }();
  return kWhole;
}

/// No file under a name that says it is whole but is not: what is there is as in the whole run.
void expect_nothing_half_written(const fs::path& partial) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(partial)) {
    const std::string name = entry.path().filename().string();
    EXPECT_FALSE(name.ends_with(".tmp") || name.ends_with(".partial")) << entry.path();
    const fs::path twin = whole().run / fs::relative(entry.path(), partial);
    const bool grows = entry.path().extension() == ".rec" || entry.path().parent_path().filename() == "records";
    if (entry.is_regular_file() && !grows && name != "manifest.json") {
      EXPECT_EQ(storage::sha256_of_file(entry.path()), storage::sha256_of_file(twin)) << entry.path();
    }
  }
}

void resume_and_compare(const fs::path& run) {
  const ProgramResult resumed = RunningProgram({"map", "--resume", run, "-q"}).wait();
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  testing_support::expect_same_products(whole().run, run);
}

class LargestFile : public testing::TestWithParam<const char*> {};

/// Files may grow to a byte less than what this one needs: it, or one before it, cannot be written.
TEST_P(LargestFile, ThatMayNotBeWrittenIsNamed) {
  const rlim_t limit = fs::file_size(whole().run / GetParam()) - 1;
  const fs::path run = kLogs.new_run("limited");
  const auto limit_files = [limit] {
    const rlimit value{limit, limit};
    ::setrlimit(RLIMIT_FSIZE, &value);
  };
  const ProgramResult result =
      RunningProgram(testing_support::map_words(whole().log, run), LOOPMARK_BINARY, limit_files).wait();
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("error: " + run.string() + ".partial"), HasSubstr("cannot write")));
  EXPECT_FALSE(fs::exists(run));
  expect_nothing_half_written(run.string() + ".partial");
  resume_and_compare(run);
}

INSTANTIATE_TEST_SUITE_P(Products, LargestFile, testing::Values("keyframes/000001.pcd", "map.ot", "map.simplemap"));

TEST(FullDisk, BeforeTheRunHasBegunLeavesNothing) {
  const fs::path log = kLogs.make_log("none_log");
  const fs::path run = kLogs.new_run("none");
  const auto limit_files = [] {
    const rlimit value{100, 100};
    ::setrlimit(RLIMIT_FSIZE, &value);
  };
  // The program's own words go to a file too, so that nothing of them is read here.
  EXPECT_EQ(RunningProgram(testing_support::map_words(log, run), LOOPMARK_BINARY, limit_files).wait().exit_code, 2);
  EXPECT_FALSE(fs::exists(run.string() + ".partial"));
}

/// A little file system of its own, where this process may make one.
class SmallDisk {
 public:
  SmallDisk(fs::path folder, std::size_t bytes) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
    mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, size_option(bytes).c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) {
      ::umount2(folder_.c_str(), MNT_DETACH);
    }
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  bool grow(std::size_t bytes) const {
    return ::mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT, size_option(bytes).c_str()) == 0;
  }

 private:
  static std::string size_option(std::size_t bytes) { return "size=" + std::to_string(bytes); }
  fs::path folder_;
  bool mounted_ = false;
};

class SmallDiskTest : public testing::TestWithParam<double> {};

TEST_P(SmallDiskTest, ThatGetsFullIsSaidAndTheRunGoesOnOnceThereIsRoom) {
  std::size_t needed = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(whole().run)) {
    needed += entry.is_regular_file() ? entry.file_size() : 0;
  }
  const fs::path folder = kLogs.scratch("disk");
  const SmallDisk disk(folder, static_cast<std::size_t>(GetParam() * static_cast<double>(needed)));
  if (!disk.mounted()) {
    GTEST_SKIP() << "a file system cannot be mounted here";
  }
  const fs::path run = folder / "run";
  const ProgramResult result = RunningProgram(testing_support::map_words(whole().log, run)).wait();
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("error: " + run.string() + ".partial"), HasSubstr("cannot write"),
                                   AnyOf(HasSubstr("No space left"), HasSubstr("disk"))));
  EXPECT_FALSE(fs::exists(run));
  expect_nothing_half_written(run.string() + ".partial");
  ASSERT_TRUE(disk.grow(4 * needed));
  resume_and_compare(run);
}

INSTANTIATE_TEST_SUITE_P(Share, SmallDiskTest, testing::Values(0.1, 0.95));

}  // namespace
}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/run_folder.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::map_store {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class RunFolderTest : public ::testing::Test {
 protected:
  RunFolderTest() { fs::remove_all(root_), fs::create_directories(root_); }
  ~RunFolderTest() override { fs::remove_all(root_); }

  void leave(const std::string& file, const std::string& content = "x") const {
    fs::create_directories((partial() / file).parent_path());
    storage::write_file_atomically(partial() / file, content);
  }
  fs::path run() const { return root_ / "run"; }
  fs::path partial() const { return root_ / "run.partial"; }

  fs::path root_ = fs::path(::testing::TempDir()) / ("loopmark_run_folder_" + std::to_string(::getpid()));
};

TEST_F(RunFolderTest, WhatCannotBeResumedIsBegunAnew) {
  leave("records/scans.rec");
  leave("map.bt");
  const RunFolder folder = RunFolder::create(run());
  EXPECT_FALSE(fs::exists(folder / "map.bt"));
  EXPECT_FALSE(fs::exists(folder.scan_records()));
  EXPECT_TRUE(fs::is_directory(folder / "keyframes"));
}

TEST_F(RunFolderTest, WhatCanBeResumedIsLeftAlone) {
  leave("records/job.json");
  EXPECT_THAT([&] { RunFolder::create(run()); }, ThrowsMessage<InputError>(HasSubstr("map --resume")));
  EXPECT_TRUE(fs::exists(partial() / "records/job.json"));
}

TEST_F(RunFolderTest, OneProcessAtATime) {
  const RunFolder folder = RunFolder::create(run());
  EXPECT_THAT([&] { RunFolder::create(run()); }, ThrowsMessage<InputError>(HasSubstr("another process")));
  leave("records/job.json");
  EXPECT_THAT([&] { RunFolder::resume(run()); }, ThrowsMessage<InputError>(HasSubstr("another process")));
}

TEST_F(RunFolderTest, TheOldRunOfARevisionThatWasKilledLastIsKept) {
  RunFolder first = RunFolder::create(run());
  storage::write_file_atomically(first / "manifest.json", "{\n \"sha256\": {}}");
  first.finish();
  leave("manifest.json", "{\n \"sha256\": {\n  \"old\": \"run\"}}");
  leave("records/job.json");
  const RunFolder revision = RunFolder::revise(run());
  EXPECT_THAT(storage::read_file(root_ / "run.before-1/manifest.json"), HasSubstr("old"));
  EXPECT_FALSE(fs::exists(revision / "manifest.json"));
}

TEST_F(RunFolderTest, AFinishedRunIsFreeForOthers) {
  RunFolder folder = RunFolder::create(run());
  storage::write_file_atomically(folder / "manifest.json", "{}");
  folder.finish();
  EXPECT_EQ(RunFolder::open(run()).path(), run());
  EXPECT_NO_THROW(RunFolder::revise(run()));
}

}  // namespace
}  // namespace loopmark::map_store

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "loopmark/core/error.hpp"

namespace loopmark::storage {
namespace {

namespace fs = std::filesystem;

TEST(WriteFileAtomically, WhatFailsHalfWayLeavesTheOldContentAndNothingElse) {
  const fs::path folder = fs::path(testing::TempDir()) / "loopmark_files_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_file_atomically(folder / "a", "before");
  EXPECT_THROW(write_file_atomically(folder / "a",
                                     [](std::ostream& stream) {
                                       stream << "half";
                                       throw std::runtime_error("no more");
                                     }),
               std::runtime_error);
  EXPECT_EQ(read_file(folder / "a"), "before");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(WriteFileAtomically, AFileThatMayNotGrowIsNamed) {
  const fs::path folder = fs::path(testing::TempDir()) / "loopmark_files_full_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 50'000, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string said;
  try {
    write_file_atomically(folder / "a", std::string(100'000, 'x'));
  } catch (const InputError& error) {
    said = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(said.find("File too large"), std::string::npos) << said;
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(WriteFileAtomically, ALinkInPlaceOfTheTemporaryFileIsNotFollowed) {
  const fs::path folder = fs::path(testing::TempDir()) / "loopmark_files_link_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_file_atomically(folder / "victim", "precious");
  fs::create_symlink(folder / "victim", folder / "a.tmp");
  write_file_atomically(folder / "a", "new");
  EXPECT_EQ(read_file(folder / "victim"), "precious");
  EXPECT_EQ(read_file(folder / "a"), "new");
}

TEST(ReadFile, StopsWhereAFileIsLargerThanItMayBe) {
  const fs::path file = fs::path(testing::TempDir()) / "loopmark_files_large_test";
  write_file_atomically(file, std::string(3U << 20U, 'x'));
  EXPECT_EQ(read_file(file, 3U << 20U).size(), 3U << 20U);
  EXPECT_THROW(read_file(file, (3U << 20U) - 1), InputError);
  EXPECT_THROW(read_file("/dev/zero", 1U << 20U), InputError);
}

TEST(PrivateFolder, IsNewAndForThisUserAlone) {
  const fs::path first = make_private_folder(testing::TempDir(), "loopmark-");
  const fs::path second = make_private_folder(testing::TempDir(), "loopmark-");
  EXPECT_NE(first, second);
  EXPECT_EQ(fs::status(first).permissions(), fs::perms::owner_all);
  EXPECT_THROW(make_private_folder("/nowhere/at/all", "x-"), InputError);
}

}  // namespace
}  // namespace loopmark::storage

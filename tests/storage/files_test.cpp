// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/files.hpp"

#include <gtest/gtest.h>

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

TEST(WriteFileAtomically, AFullDiskIsNamed) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full";
  }
  const fs::path folder = fs::path(testing::TempDir()) / "loopmark_files_full_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  fs::create_symlink("/dev/full", folder / "a.tmp");
  try {
    write_file_atomically(folder / "a", std::string(100'000, 'x'));
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace loopmark::storage

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Writes a run for the tests in a browser: sample_run FOLDER.
#include <cstdio>
#include <filesystem>

#include "app/synthetic_run.hpp"

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: sample_run FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = words[1];
  for (const char* ending : {"", ".before-1", ".partial"}) {
    std::filesystem::remove_all(folder.string() + ending);
  }
  std::filesystem::create_directories(folder.parent_path());
  loopmark::testing_support::SyntheticRun run(folder);
  return 0;
}

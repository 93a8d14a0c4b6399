// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A real drive found again in a map of its own other scans; the truth lies beside the log.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "loopmark/io/trajectory.hpp"
#include "loopmark/storage/files.hpp"
#include "support/run_program.hpp"
#include "support/shared_data.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using testing_support::ProgramResult;
using testing_support::run_program;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// A log of every other scan of `log`, `first` and before `end`, by links.
void write_every_other(const fs::path& log, const fs::path& part, std::size_t first, std::size_t end) {
  fs::create_directories(part / "velodyne");
  fs::copy(log / "sweep.txt", part / "sweep.txt");
  const std::vector<std::string> times = lines_of(log / "times.txt");
  const std::vector<std::string> poses = lines_of(log / "poses.txt");
  std::ofstream times_of_part(part / "times.txt");
  std::ofstream poses_of_part(part / "poses.txt");
  std::vector<fs::path> scans;
  for (const fs::directory_entry& entry : fs::directory_iterator(log / "velodyne")) {
    scans.push_back(entry.path());
  }
  std::sort(scans.begin(), scans.end());
  for (std::size_t i = first, place = 0; i < std::min(end, scans.size()); i += 2, ++place) {
    char name[16];
    std::snprintf(name, sizeof name, "%06zu", place);
    fs::create_symlink(scans[i], part / "velodyne" / (name + scans[i].extension().string()));
    times_of_part << times.at(i) << "\n";
    poses_of_part << poses.at(i) << "\n";
  }
}

class RelocalizationOnLogs : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto log = testing_support::unpacked_log("kitti_raw_city");
    if (!log) {
      GTEST_SKIP() << "no shared logs";
    }
    fs::remove_all(folder_);
    write_every_other(*log, folder_ / "even", 0, 100);
    write_every_other(*log, folder_ / "odd", 1, 100);
    const ProgramResult mapped = run_program({"map", folder_ / "even", "-o", folder_ / "run", "-q"});
    ASSERT_EQ(mapped.exit_code, 0) << mapped.output;
  }
  void TearDown() override { fs::remove_all(folder_); }

  nlohmann::json relocalize(std::vector<std::string> more) const {
    std::vector<std::string> words = {"relocalize",      folder_ / "run",
                                      folder_ / "odd",   "-o",
                                      folder_ / "where", "-q",
                                      "--map-truth",     folder_ / "even" / "poses.txt"};
    words.insert(words.end(), more.begin(), more.end());
    fs::remove_all(folder_ / "where");
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return nlohmann::json::parse(storage::read_file(folder_ / "where" / "summary.json"));
  }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("loopmark_relocalization_on_logs_" + std::to_string(::getpid()));
};

TEST_F(RelocalizationOnLogs, OddScansAreFoundInAMapOfTheEvenOnes) {
  const nlohmann::json followed = relocalize({});
  EXPECT_EQ(followed["scans"], 50);
  EXPECT_GE(followed["judged"], 48) << storage::read_file(folder_ / "where" / "relocalization.csv");
  EXPECT_EQ(followed["wrong"], 0) << storage::read_file(folder_ / "where" / "relocalization.csv");
  EXPECT_EQ(followed["losses"], 0) << storage::read_file(folder_ / "where" / "relocalization.csv");
  EXPECT_LE(followed["first_answer_s"], 2.0);
  EXPECT_LT(followed["median_error_m"], 0.15);

  const nlohmann::json alone = relocalize({"--single", "--every", "10"});
  EXPECT_EQ(alone["scans"], 5);
  EXPECT_GE(alone["judged"], 4) << storage::read_file(folder_ / "where" / "relocalization.csv");
  EXPECT_EQ(alone["wrong"], 0) << storage::read_file(folder_ / "where" / "relocalization.csv");
}

}  // namespace
}  // namespace loopmark::app

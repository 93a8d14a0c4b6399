// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark map on logs with gaps, a jump, and a part from elsewhere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "loopmark/storage/files.hpp"
#include "street_log.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using namespace testing_support;
using ::testing::HasSubstr;

class Heal : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("loopmark_heal_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  nlohmann::json mapped(const std::string& name, const std::vector<StreetScan>& scans) {
    write_street_log(folder_ / (name + "_log"), scans);
    std::vector<std::string> words = {"map", folder_ / (name + "_log"), "-o", folder_ / name};
    words.insert(words.end(), kStreetOptions.begin(), kStreetOptions.end());
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    output_ = result.output;
    return nlohmann::json::parse(storage::read_file(folder_ / name / "summary.json"));
  }

  fs::path folder_;
  std::string output_;
};

void append(std::vector<StreetScan>& drive, const std::vector<StreetScan>& more) {
  drive.insert(drive.end(), more.begin(), more.end());
}

TEST_F(Heal, ADriveWithGapsAndAJumpBecomesOneMapAgain) {
  const BoxWorld street_a = street(120.0, 5);
  std::vector<StreetScan> cut = driven(street_a, 0, 30, 0.0);
  append(cut, driven(street_a, 62, 100, 8.0));  // 5 s without scans
  append(cut, driven(street_a, 100, 80, 12.0));
  append(cut, driven(street_a, 20, 0, 14.1));   // 60 m further from one scan to the next
  append(cut, driven(street_a, 60, 90, 80.0));  // a minute later
  const nlohmann::json healed = mapped("healed", cut);
  EXPECT_EQ(healed["components"], 1) << output_;
  EXPECT_GE(healed["parts"][0]["segments"], 4) << "each gap and the jump start a new one";
  EXPECT_LT(healed["ate_rmse_m"].get<double>(), 0.1) << output_;
}

TEST_F(Heal, APartFromElsewhereStaysApartByName) {
  const BoxWorld here = street(120.0, 5);
  const BoxWorld elsewhere = street(120.0, 77);
  std::vector<StreetScan> drive = driven(here, 0, 60, 0.0);
  append(drive, driven(elsewhere, 40, 70, 20.0));
  const nlohmann::json summary = mapped("apart", drive);
  ASSERT_EQ(summary["components"], 2) << output_;
  EXPECT_EQ(summary["parts"][0]["name"], "main");
  EXPECT_EQ(summary["parts"][0]["scans"], 60);
  EXPECT_EQ(summary["parts"][1]["name"], "component_1");
  EXPECT_FALSE(summary["parts"][1]["anchored"].get<bool>());
  EXPECT_EQ(summary["parts"][1]["first_scan"], 60);
  EXPECT_GT(summary["parts"][1]["candidates_to_others"], 0) << "it must have been tried";
  EXPECT_LT(summary["ate_rmse_m"].get<double>(), 0.2) << "of the scans that have a place in the map";
  const fs::path run = folder_ / "apart";
  EXPECT_EQ(io::read_trajectory(run / "trajectory.tum").poses.size(), 90U) << "nothing is thrown away";
  EXPECT_THAT(storage::read_file(run / "trajectory.tum"), HasSubstr("# component_1: 30 scans"));
  EXPECT_EQ(io::read_trajectory(run / "component_1.tum").poses.size(), 30U);
  EXPECT_TRUE(fs::exists(run / "component_1.ply"));
  EXPECT_THAT(storage::read_file(run / "components.csv"), HasSubstr("component_1,0,30,60,89"));
  EXPECT_THAT(storage::read_file(run / "report.html"), HasSubstr("component_1"));
  EXPECT_THAT(output_, HasSubstr("component_1 (30 scans"));
}

/// The map is the largest part, also where the log starts with a short one.
TEST_F(Heal, ThePartWithMostKeyframesIsTheMap) {
  const BoxWorld here = street(120.0, 5);
  const BoxWorld elsewhere = street(120.0, 77);
  std::vector<StreetScan> drive = driven(elsewhere, 40, 52, 0.0);
  append(drive, driven(here, 0, 60, 20.0));
  const nlohmann::json summary = mapped("late", drive);
  ASSERT_EQ(summary["components"], 2) << output_;
  EXPECT_EQ(summary["parts"][0]["scans"], 60);
  EXPECT_EQ(summary["parts"][1]["first_scan"], 0);
  EXPECT_LT(summary["ate_rmse_m"].get<double>(), 0.2);
}

}  // namespace
}  // namespace loopmark::app

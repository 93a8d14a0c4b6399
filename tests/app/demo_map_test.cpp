// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The map in maps/ can be used by the program as it is. Where records have changed: scripts/make-demo-map.sh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "loopmark/storage/files.hpp"
#include "support/run_program.hpp"

namespace loopmark::app {
namespace {

using testing_support::ProgramResult;
using testing_support::run_program;

TEST(DemoMap, ScansOfAnotherDayAreFoundInIt) {
  const std::string maps = LOOPMARK_SOURCE_DIR "/maps";
  const std::filesystem::path out = testing::TempDir() + "loopmark_demo_map_test";
  std::filesystem::remove_all(out);
  const ProgramResult result = run_program({"relocalize", maps + "/demo", maps + "/demo-query", "-o", out.string(),
                                            "--map-truth", maps + "/demo/records/truth.tum"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto summary = nlohmann::json::parse(storage::read_file(out / "summary.json"));
  EXPECT_EQ(summary.at("scans"), 4);
  EXPECT_EQ(summary.at("answered"), 4);
  EXPECT_EQ(summary.at("judged"), 4);
  EXPECT_EQ(summary.at("wrong"), 0);
  EXPECT_LT(summary.at("median_error_m").get<double>(), 0.3);
  std::filesystem::remove_all(out);
}

}  // namespace
}  // namespace loopmark::app

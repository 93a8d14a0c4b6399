// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_page/map_page.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "loopmark/core/parallel.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/web_page/bundle.hpp"
#include "map_page/sample_runs.hpp"

namespace loopmark::map_page {
namespace {

using testing_support::SampleRun;
using testing_support::scene_run;
using testing_support::town_run;

std::string html(const SampleRun& run, const MapPageOptions& options = {}) {
  std::ostringstream out;
  map_page(run.input(), options).write(out);
  return out.str();
}

nlohmann::json data_of(const std::string& page) {
  const std::string begin = "id=\"page-data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(MapPage, IsTheSameAtAnyNumberOfThreads) {
  const SampleRun run = town_run(1200, 20, 60);
  set_thread_count(1);
  const std::string one = html(run);
  set_thread_count(4);
  const std::string four = html(run);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(MapPage, NamesCannotLeaveTheirElement) {
  SampleRun run = scene_run();
  run.name = "</script><img src=x onerror=alert(1)>";
  run.scans[3].problem = "<script>alert(2)</script>";
  const std::string page = html(run);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(data_of(page)["name"], run.name);
  EXPECT_EQ(data_of(page)["problems"]["3"], run.scans[3].problem);
}

TEST(MapPage, ANameThatIsNoUtf8IsShownAllTheSame) {
  SampleRun run = scene_run();
  run.name = "run \xff";
  EXPECT_EQ(data_of(html(run))["name"], "run \xEF\xBF\xBD");
}

TEST(MapPage, EveryPointOfASmallCloudIsThereOrStandsBesideAnotherInItsVoxel) {
  if (!web_page::bundle().problem.empty()) {
    GTEST_SKIP() << web_page::bundle().problem;
  }
  const nlohmann::json data = data_of(html(scene_run()));
  // Each cube is 0.5 m wide: at most 4 voxels of 0.2 m along each axis, at least 2, in each of the three chunks.
  const std::size_t points = data["cloud"]["points"];
  EXPECT_EQ(data["cloud"]["of"], points);
  EXPECT_GE(points, 4U * 8U * data["chunks"].size());
  EXPECT_LE(points, 4U * 64U * data["chunks"].size());
  std::size_t keyframes = 0;
  for (const nlohmann::json& chunk : data["chunks"]) {
    EXPECT_EQ(chunk["first"], keyframes);
    keyframes += chunk["keyframes"].get<std::size_t>();
    EXPECT_EQ(chunk["levels"].back(), chunk["points"]);
  }
  EXPECT_EQ(keyframes, 21U);
}

TEST(MapPage, MorePointsThanFitAreThinnedAndTheirNumberIsTold) {
  if (!web_page::bundle().problem.empty()) {
    GTEST_SKIP() << web_page::bundle().problem;
  }
  const SampleRun run = town_run(1200, 0, 200);
  const nlohmann::json all = data_of(html(run))["cloud"];
  const nlohmann::json few = data_of(html(run, {.max_points = 20'000}))["cloud"];
  EXPECT_GT(all["points"], 40'000U);
  EXPECT_LT(few["points"], 22'000U);  // what is left out is decided by samples
  EXPECT_GT(few["voxel_m"], all["voxel_m"]);
  EXPECT_NEAR(few["of"].get<double>(), all["of"].get<double>(), 0.1 * all["of"].get<double>());
}

TEST(MapPage, TakesTheCloudOfAnEarlierPageOfTheSameKeyframes) {
  const SampleRun run = town_run(1200, 20, 60);
  const std::string anew = html(run);
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "earlier_page.html";
  storage::write_file_atomically(file, anew);
  MapPageInput input = run.input();
  input.earlier_page = file;
  input.keyframe_cloud = [](std::size_t) -> PointCloud { throw std::logic_error("a keyframe was read"); };
  std::ostringstream again;
  map_page(input).write(again);
  EXPECT_EQ(again.str(), anew);
  const SampleRun longer = town_run(1300, 20, 60);
  MapPageInput longer_input = longer.input();
  longer_input.earlier_page = file;
  std::ostringstream other;
  map_page(longer_input).write(other);
  EXPECT_EQ(other.str(), html(longer));
  std::filesystem::remove(file);
}

TEST(MapPage, SaysWhatItLacksWhereNoScriptWasBuiltIn) {
  const std::string page = html(scene_run());
  const std::string problem(web_page::bundle().problem);
  EXPECT_EQ(page.find("This page has no map") != std::string::npos, !problem.empty());
  EXPECT_NE(page.find("near the threshold"), std::string::npos);  // the findings stand there in any case
}

}  // namespace
}  // namespace loopmark::map_page

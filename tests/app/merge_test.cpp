// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark merge and extend as a user runs them, on drives along synthetic streets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "loopmark/storage/files.hpp"
#include "street_log.hpp"
#include "support/run_program.hpp"
#include "synthetic_run.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;
using namespace testing_support;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Merge : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / ("loopmark_merge_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  std::string log(const std::string& name, const std::vector<StreetScan>& scans, int beams) {
    write_street_log(folder_ / name, scans, beams, std::hash<std::string>()(name));
    return at(name);
  }
  /// Maps a drive with its own sensor into the run `name`.
  void map(const std::string& name, const std::vector<StreetScan>& scans, int beams = 24) {
    std::vector<std::string> words = {"map", log(name + "_log", scans, beams), "-o", at(name)};
    words.insert(words.end(), kStreetOptions.begin(), kStreetOptions.end());
    const ProgramResult result = run_program(words);
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  nlohmann::json summary(const std::string& run) const {
    return nlohmann::json::parse(storage::read_file(folder_ / run / "summary.json"));
  }

  /// Candidates of a run that stand in its records more than once.
  std::ptrdiff_t pairs_tried_twice(const std::string& run) const {
    std::istringstream csv(storage::read_file(folder_ / run / "loops.csv"));
    std::multiset<std::string> pairs;
    for (std::string line; std::getline(csv, line);) {
      pairs.insert(line.substr(0, line.find(',', line.find(',') + 1)));
    }
    return std::count_if(pairs.begin(), pairs.end(), [&](const std::string& pair) { return pairs.count(pair) > 1; });
  }

  fs::path folder_;
};

TEST_F(Merge, DrivesOfOneStreetBecomeOneMapAndAForeignOneIsLeftOut) {
  const BoxWorld here = street(80.0, 5);
  const BoxWorld elsewhere = street(80.0, 77);
  map("there", driven(here, 0, 60, 0.0));
  map("back", driven(here, 70, 10, 0.0));
  map("thin", driven(here, 15, 75, 0.0), 16);
  map("far", driven(elsewhere, 0, 50, 0.0));

  const ProgramResult result =
      run_program({"merge", at("far"), at("back"), at("there"), at("thin"), "-o", at("town"), "--one-frame", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("warning: drive 'far' (50 scans) does not belong and is left out: "));
  const nlohmann::json town = summary("town");
  EXPECT_EQ(town["scans"], 180);
  EXPECT_EQ(town["components"], 1);
  EXPECT_LT(town["ate_rmse_m"].get<double>(), 0.25) << result.output;
  ASSERT_EQ(town["drives"].size(), 4U);
  EXPECT_FALSE(town["drives"][0]["belongs"].get<bool>());
  EXPECT_EQ(town["drives"][3]["name"], "thin");
  EXPECT_EQ(town["drives"][3]["first_scan"], 120);
  EXPECT_FALSE(fs::exists(at("town") + ".partial"));
  for (const char* product : {"trajectory.tum", "trajectory.kitti", "covariances.csv", "loops.csv", "pose_graph.g2o",
                              "components.csv", "map.bt", "map.ot", "cloud.ply", "map.simplemap", "map.3Dscene",
                              "config.yaml", "report.html", "manifest.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / "town" / product)) << product;
  }

  // What works on a run works on this one, also without the runs it was made from.
  fs::remove_all(at("there"));
  fs::remove_all(at("back"));
  const ProgramResult loops = run_program({"loops", at("town"), "--csv"});
  EXPECT_EQ(loops.exit_code, 0) << loops.output;
  const ProgramResult why = run_program({"why", at("town"), "k0", "k30"});
  EXPECT_EQ(why.exit_code, 0) << why.output;
  const ProgramResult where =
      run_program({"relocalize", at("town"), log("query", driven(here, 30, 36, 0.0), 24), "-o", at("where"), "--single",
                   "--map-truth", at("town") + "/records/truth.tum", "-q", "--set", "slam.compensation=compensated"});
  EXPECT_EQ(where.exit_code, 0) << where.output;
  EXPECT_THAT(where.output, HasSubstr(" 0 of ")) << "no wrong answer: " << where.output;

  map("more", driven(here, 80, 40, 0.0));
  const ProgramResult again = run_program({"merge", at("town"), at("more"), "-o", at("town2"), "--one-frame", "-q"});
  ASSERT_EQ(again.exit_code, 0) << again.output;
  EXPECT_EQ(summary("town2")["scans"], 220);
  EXPECT_EQ(summary("town2")["drives"].size(), 4U);
  EXPECT_EQ(pairs_tried_twice("town2"), 0) << "those of the earlier drives are on record";
  EXPECT_LT(summary("town2")["ate_rmse_m"].get<double>(), 0.25);
  const ProgramResult twice = run_program({"merge", at("town2"), at("thin"), "-o", at("town3")});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.output, HasSubstr("is given twice"));
}

TEST_F(Merge, NothingIsLeftBehindWhereNoTwoDrivesHangTogether) {
  const BoxWorld here = street(60.0, 5);
  const BoxWorld elsewhere = street(60.0, 77);
  map("here", driven(here, 0, 30, 0.0));
  map("far", driven(elsewhere, 0, 30, 0.0));
  const ProgramResult result = run_program({"merge", at("here"), at("far"), "-o", at("both"), "-q"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("no two of the drives hang together"), HasSubstr("pairs of places tried")));
  EXPECT_FALSE(fs::exists(at("both")));
  EXPECT_FALSE(fs::exists(at("both") + ".partial"));
}

TEST_F(Merge, ExtendMapsALogAndJoinsIt) {
  const BoxWorld here = street(80.0, 5);
  const BoxWorld elsewhere = street(80.0, 77);
  map("run", driven(here, 0, 50, 0.0));
  const std::string more = log("more", driven(here, 70, 10, 0.0), 24);
  const std::string foreign = log("foreign", driven(elsewhere, 0, 40, 0.0), 24);
  const std::string before = storage::read_file(folder_ / "run/manifest.json");
  const auto extend = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "extend");
    words.insert(words.end(), kStreetOptions.begin(), kStreetOptions.end());
    return run_program(words);
  };
  const ProgramResult refused = extend({at("run"), foreign, "-o", at("bad")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output, AllOf(HasSubstr("nothing is changed"), HasSubstr("bad.drive")));
  EXPECT_TRUE(fs::exists(at("bad.drive") + "/manifest.json")) << "the log's own map is kept";
  EXPECT_FALSE(fs::exists(at("bad")));

  const ProgramResult beside = extend({at("run"), more, "-o", at("wider"), "--one-frame"});
  ASSERT_EQ(beside.exit_code, 0) << beside.output;
  EXPECT_EQ(summary("wider")["scans"], 110);
  EXPECT_LT(summary("wider")["ate_rmse_m"].get<double>(), 0.25);
  EXPECT_FALSE(fs::exists(at("wider.drive")));
  EXPECT_EQ(storage::read_file(folder_ / "run/manifest.json"), before);

  const ProgramResult in_place = extend({at("run"), more});
  ASSERT_EQ(in_place.exit_code, 0) << in_place.output;
  EXPECT_EQ(summary("run")["scans"], 110);
  EXPECT_EQ(storage::read_file(folder_ / "run.before-1/manifest.json"), before);
  EXPECT_EQ(extend({at("run"), more, "-o", at("wider")}).exit_code, 2) << "never overwritten";
  EXPECT_EQ(extend({at("nowhere"), more, "-o", at("x")}).exit_code, 2);
  EXPECT_EQ(extend({at("run"), at("nowhere"), "-o", at("x")}).exit_code, 2);
  EXPECT_FALSE(fs::exists(at("x.drive.partial")));
}

TEST_F(Merge, ExtendSaysWhichEarlierDriveNoLongerHangsTogetherAndGoesOn) {
  const BoxWorld here = street(80.0, 5);
  map("there", driven(here, 0, 45, 0.0));
  map("edge", driven(here, 80, 52, 0.0));
  const ProgramResult merged = run_program({"merge", at("there"), at("edge"), "-o", at("run"), "--one-frame", "-q"});
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  const std::string more = log("more", driven(here, 45, 0, 0.0), 24);
  const ProgramResult result =
      run_program({"extend", at("run"), more, "--one-frame", "-q", "--set", "slam.compensation=compensated", "--set",
                   "slam.segment_candidates=1", "--set", "pose_graph.min_links=14"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("warning: drive 'edge' (28 scans) does not belong and is left out: "));
  const nlohmann::json extended = summary("run");
  EXPECT_EQ(extended["scans"], 90) << "those that hang together";
  EXPECT_EQ(extended["components"], 1);
  EXPECT_LT(extended["ate_rmse_m"].get<double>(), 0.25);
  EXPECT_EQ(summary("run.before-1")["scans"], 73) << "nothing is thrown away";
}

TEST_F(Merge, SaysWhatIsWrongWithTheRuns) {
  const SyntheticRun made(folder_ / "one");
  fs::copy(folder_ / "one", folder_ / "copy", fs::copy_options::recursive);
  const auto manifest = [&](const std::string& run, const std::string& program) {
    storage::write_file_atomically(
        folder_ / run / "manifest.json",
        "{\"program\": \"" + program + "\", \"input\": {\"log\": \"somewhere\"}, \"sha256\": {}}\n");
  };
  manifest("one", "loopmark 0.2.0");
  manifest("copy", "loopmark 0.2.7");
  fs::create_directories(folder_ / "old");
  fs::copy(folder_ / "one", folder_ / "old", fs::copy_options::recursive);
  manifest("old", "loopmark 9.4.2");
  fs::create_directories(folder_ / "half.partial");
  fs::create_directories(folder_ / "empty");
  const auto told = [&](const std::vector<std::string>& runs, const std::string& problem) {
    std::vector<std::string> words = {"merge"};
    for (const std::string& run : runs) {
      words.push_back(at(run));
    }
    words.insert(words.end(), {"-o", at("out")});
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    EXPECT_THAT(result.output, HasSubstr(problem));
    EXPECT_FALSE(fs::exists(at("out.partial")));
  };
  told({"one"}, "needs two runs or more");
  told({"one", "nowhere"}, "there is no run");
  told({"one", "empty"}, "there is no run");
  told({"one", "half"}, "the run is not whole yet");
  told({"one", "one"}, "is given twice");
  told({"one", "copy"}, "is given twice");
  told({"one", "old"}, "was made by loopmark 9.4.2, this is loopmark");
  storage::write_file_atomically(folder_ / "old/manifest.json", "{\"program\": ");
  told({"one", "old"}, "is damaged");
  fs::create_directories(folder_ / "there");
  const ProgramResult taken = run_program({"merge", at("one"), at("copy"), "-o", at("there")});
  EXPECT_EQ(taken.exit_code, 2);
  const ProgramResult help = run_program({"merge", "--help"});
  EXPECT_THAT(help.output, AllOf(HasSubstr("loopmark merge runs/day1 runs/day2"), Not(HasSubstr("internal"))));
}

}  // namespace
}  // namespace loopmark::app

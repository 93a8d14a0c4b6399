// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark balance and evaluate on small drives in the layouts of the published data sets.
#include <gmock/gmock.h>

#include "app/layout_writers.hpp"
#include "loopmark/cloud/overlap.hpp"
#include "loopmark/io/dataset.hpp"
#include "loopmark/storage/files.hpp"
#include "pair_sets/pair_files.hpp"
#include "support/run_program.hpp"

namespace loopmark {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing_support::run_program;

class BalanceProgram : public testing::Test {
 protected:
  /// Chooses a set and checks every overlap in it against the scans, read anew.
  void balance_and_check(const fs::path& root, std::size_t pairs) {
    const std::vector<std::string> command = {"balance", root, "--pairs", std::to_string(pairs), "--quiet", "-o"};
    for (const char* name : {"set", "again"}) {
      auto words = command;
      words.push_back(folder_ / name);
      const auto result = run_program(words);
      ASSERT_EQ(result.exit_code, 0) << result.output;
    }
    EXPECT_EQ(storage::read_file(folder_ / "set/pairs.txt"), storage::read_file(folder_ / "again/pairs.txt"));
    const auto set = pair_sets::read_pair_set(folder_ / "set/pairs.txt");
    EXPECT_EQ(set.size(), pairs);
    const auto data = io::open_dataset(root);
    for (const pair_sets::RegistrationPair& pair : set) {
      const auto poses = data->poses(pair.key.session);
      const Pose T = poses[data->frame_index(pair.key.session, pair.key.target)].inverse() *
                     poses[data->frame_index(pair.key.session, pair.key.source)];
      EXPECT_LT(pose_error(T, pair.T_target_source).translation_m, 1e-9);
      const cloud::Overlap again = cloud::overlap(data->load(pair.key.session, pair.key.source),
                                                  data->load(pair.key.session, pair.key.target), T);
      EXPECT_NEAR(again.symmetric, pair.overlap_symmetric, 1e-12);
      EXPECT_GE(again.symmetric, 0.2);
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(BalanceProgram, ChoosesFromKittiDrives) {
  test::write_kitti_layout(folder_ / "kitti",
                           {test::circle_drive(2, 60, 0, 0.0), test::circle_drive(5, 40, 0, 1.0, -1.0)});
  balance_and_check(folder_ / "kitti", 24);
}

TEST_F(BalanceProgram, ChoosesFromApolloFramesThatCountFromOne) {
  test::write_apollo_layout(folder_ / "apollo", test::circle_drive(20, 50, 1, 0.5));
  balance_and_check(folder_ / "apollo", 12);
  for (const pair_sets::RegistrationPair& pair : pair_sets::read_pair_set(folder_ / "set/pairs.txt")) {
    EXPECT_GE(pair.key.source, 1);
    EXPECT_EQ(pair.key.session, 20);
  }
}

TEST_F(BalanceProgram, ChoosesFromNuScenesSweeps) {
  test::write_nuscenes_layout(folder_ / "nuscenes", test::circle_drive(0, 50, 0, 0.5));
  balance_and_check(folder_ / "nuscenes", 12);
}

TEST_F(BalanceProgram, SubsetsKeepToTheirDrives) {
  test::write_kitti_layout(folder_ / "kitti",
                           {test::circle_drive(2, 40, 0, 0.0), test::circle_drive(5, 40, 0, 1.0, -1.0)});
  const auto result = run_program({"balance", folder_ / "kitti", "--subset", "train:10:2", "--subset", "test:8:5",
                                   "--quiet", "-o", folder_ / "set"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(pair_sets::read_pair_set(folder_ / "set/train.txt").size(), 10U);
  for (const pair_sets::RegistrationPair& pair : pair_sets::read_pair_set(folder_ / "set/test.txt")) {
    EXPECT_EQ(pair.key.session, 5);
  }
}

TEST_F(BalanceProgram, DrivesWithoutPosesAreTold) {
  io::write_bin((fs::create_directories(folder_ / "log/velodyne"), folder_ / "log/velodyne/000000.bin"),
                test::circle_drive(0, 1, 0, 0.0).load(0));
  const auto result = run_program({"balance", folder_ / "log", "-o", folder_ / "set"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("pose"));
}

/// What loopmark evaluate says of data that does not fit its set; the competitor is never asked.
class EvaluateBadData : public BalanceProgram {
 protected:
  void SetUp() override {
    test::write_apollo_layout(folder_ / "apollo", test::circle_drive(20, 30, 1, 0.5));
    write_text_set({20, 1, 5, 20}, 0.5);
  }
  void write_text_set(const pair_sets::PairKey& key, double overlap, double extra_m = 0.0) {
    const pair_sets::Drive drive = test::circle_drive(20, 30, 1, 0.5);
    Pose T = drive.T_world_cloud[4].inverse() * drive.T_world_cloud[0];
    T.translation().x() += extra_m;
    pair_sets::write_pair_set(folder_ / "set.txt", {pair_sets::make_pair(key, T, overlap, overlap)});
  }
  testing_support::ProgramResult evaluate() const {
    return run_program({"evaluate", folder_ / "set.txt", "--data", folder_ / "apollo", "--command",
                        "echo=sh -c 'echo ready; while read w s t; do echo failed not tried; done'", "--quiet", "-o",
                        folder_ / "result"});
  }
};

TEST_F(EvaluateBadData, FramesThatDoNotExist) {
  write_text_set({20, 1, 99, 20}, 0.5);
  const auto result = evaluate();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, AllOf(HasSubstr("frame 99 does not exist"), HasSubstr("1 to 30")));
}

TEST_F(EvaluateBadData, AnIndexFromZeroWhereTheSetCountsFromOne) {
  write_text_set({20, 0, 4, 20}, 0.5);
  const auto result = evaluate();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("counts from 1"));
}

TEST_F(EvaluateBadData, ASessionThatIsNotThere) {
  write_text_set({3, 1, 4, 3}, 0.5);
  EXPECT_EQ(evaluate().exit_code, 2);
}

TEST_F(EvaluateBadData, ScansOfAnotherDataSet) {
  write_text_set({20, 1, 5, 20}, 0.9, 200.0);
  const auto result = evaluate();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr("the scans do not fit the set"));
}

TEST_F(EvaluateBadData, FittingDataIsTaken) {
  const pair_sets::Drive drive = test::circle_drive(20, 30, 1, 0.5);
  const Pose T = drive.T_world_cloud[4].inverse() * drive.T_world_cloud[0];
  const cloud::Overlap truth = cloud::overlap(drive.load(0), drive.load(4), T);
  write_text_set({20, 1, 5, 20}, truth.symmetric);
  const auto result = evaluate();
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("| echo | 1 | 0.00 % |"));
  for (const char* file : {"results.csv", "summary.json", "report.html", "tables/overview.tex", "motions/echo.txt"}) {
    EXPECT_TRUE(fs::exists(folder_ / "result" / file)) << file;
  }
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

TEST_F(EvaluateBadData, EveryFailedPairHasOnePictureHoweverManyFailedOnIt) {
  const pair_sets::Drive drive = test::circle_drive(20, 30, 1, 0.5);
  std::vector<pair_sets::RegistrationPair> pairs;
  for (int i = 1; i <= 5; ++i) {
    const auto at = static_cast<std::size_t>(i - 1);
    pairs.push_back(pair_sets::make_pair({20, i, i + 4, 20},
                                         drive.T_world_cloud[at + 4].inverse() * drive.T_world_cloud[at], 0.5, 0.5));
  }
  pair_sets::write_pair_set(folder_ / "set.txt", pairs);
  const auto competitor = [](const std::string& name, const std::string& x) {
    return name + "=sh -c 'echo ready; while read w s t; do echo motion 1 0 0 " + x +
           " 0 1 0 0 0 0 1 0 0 0 0 1 0.5 0.1; done'";
  };
  const auto report = [&](const std::string& folder, const std::string& most) {
    const auto result = run_program({"evaluate", folder_ / "set.txt", "--data", folder_ / "apollo", "--no-check",
                                     "--command", competitor("here", "0"), "--command", competitor("there", "30"),
                                     "--command", "none=sh -c 'echo ready; while read w s t; do echo failed so; done'",
                                     "--pictures", most, "--quiet", "-o", folder_ / folder});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return storage::read_file(folder_ / folder / "report.html");
  };
  const std::string all = report("all", "500");
  EXPECT_EQ(count_of(all, "<img "), 5U);
  EXPECT_THAT(all, AllOf(HasSubstr("here: TE"), HasSubstr("there: TE"), HasSubstr("none: failed")));
  const std::string some = report("some", "2");
  EXPECT_EQ(count_of(some, "<img "), 2U);
  EXPECT_THAT(some, HasSubstr("The first 2 of 5 pairs are drawn"));
}

}  // namespace
}  // namespace loopmark

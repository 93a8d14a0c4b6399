// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark evaluate as a program: published motions, kills, shards.
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "loopmark/storage/files.hpp"
#include "pair_sets/pair_files.hpp"
#include "support/run_program.hpp"
#include "support/shared_data.hpp"

namespace loopmark {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::run_program;
using testing_support::RunningProgram;

struct PublishedMotions {
  const char* set;
  double recall;  ///< at 5 deg / 0.6 m, measured from the published files by other means
};

class PublishedCoarseMotions : public testing::TestWithParam<PublishedMotions> {};

TEST_P(PublishedCoarseMotions, HaveTheirRecall) {
  const auto folder = testing_support::shared_path(std::string("balanced_sets/") + GetParam().set);
  if (!folder) {
    GTEST_SKIP() << "the published sets are not here";
  }
  const test::TemporaryFolder out;
  const auto result = run_program({"evaluate", *folder / "test.txt", "--motions", *folder / "test.coarse_motions.txt",
                                   "--quiet", "-o", out / "result"});
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto json = nlohmann::json::parse(storage::read_file(out / "result/summary.json"));
  EXPECT_NEAR(100.0 * json["algorithms"][0]["recall"].get<double>(), GetParam().recall, 0.005);
}

INSTANTIATE_TEST_SUITE_P(All, PublishedCoarseMotions,
                         testing::Values(PublishedMotions{"ApolloSouthbay", 97.06},
                                         PublishedMotions{"NuScenes_boston", 82.79},
                                         PublishedMotions{"NuScenes_singapore", 89.51}));

/// A made-up set with motions of which some are wrong.
class EvaluateProgram : public testing::Test {
 protected:
  EvaluateProgram() {
    const auto pairs = test::random_pairs(1200, 6);
    pair_sets::write_pair_set(folder_ / "set.txt", pairs);
    std::vector<pair_sets::PairMotion> motions;
    for (const pair_sets::RegistrationPair& pair : pairs) {
      motions.push_back({pair.key, pair.T_target_source});
      motions.back().T_target_source.translation().x() += pair.key.source % 4 == 0 ? 1.0 : 0.1;
    }
    pair_sets::write_motions(folder_ / "motions.txt", motions);
  }
  std::vector<std::string> command(const std::string& result, const std::string& shard = "1/1") const {
    return {"evaluate",      folder_ / "set.txt", "--motions", "m=" + (folder_ / "motions.txt").string(),
            "--quiet",       "--shard",           shard,       "-o",
            folder_ / result};
  }
  std::string bytes(const std::string& result) const {
    std::string all;
    for (const char* file : {"results.csv", "motions/m.txt", "tables/overview.md", "tables/errors.tex"}) {
      all += storage::read_file(folder_ / result / file);
    }
    return all;
  }

  test::TemporaryFolder folder_;
};

TEST_F(EvaluateProgram, KilledAtRandomMomentsItResumesToTheSameBytes) {
  ASSERT_EQ(run_program(command("whole")).exit_code, 0);
  const std::string expected = bytes("whole");
  Rng rng(static_cast<std::uint64_t>(::getpid()));
  int killed = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const std::string name = "killed" + std::to_string(trial);
    {
      RunningProgram program(command(name));
      ::usleep(5000 + rng.below(150000));
      program.send(SIGKILL);
      killed += program.wait().exit_code == 128 + SIGKILL ? 1 : 0;
    }
    const auto again = run_program(command(name));
    ASSERT_EQ(again.exit_code, 0) << again.output;
    EXPECT_EQ(bytes(name), expected);
    fs::remove_all(folder_ / name);
  }
  EXPECT_GT(killed, 5);
}

TEST_F(EvaluateProgram, ShardsAtTheSameTimeMergeToTheSameBytes) {
  ASSERT_EQ(run_program(command("whole")).exit_code, 0);
  {
    RunningProgram one(command("parts", "1/3"));
    RunningProgram two(command("parts", "2/3"));
    EXPECT_EQ(one.wait().exit_code, 0);
    EXPECT_EQ(two.wait().exit_code, 0);
  }
  const auto early = run_program({"evaluate", "merge", folder_ / "parts"});
  EXPECT_EQ(early.exit_code, 2);
  EXPECT_THAT(early.output, HasSubstr("outcomes are missing"));
  EXPECT_EQ(run_program(command("parts", "3/3")).exit_code, 0);
  EXPECT_EQ(run_program({"evaluate", "merge", folder_ / "parts"}).exit_code, 0);
  EXPECT_EQ(bytes("parts"), bytes("whole"));
}

TEST_F(EvaluateProgram, ComparesAndMakesThePapersTables) {
  ASSERT_EQ(run_program(command("a")).exit_code, 0);
  const auto compared = run_program({"evaluate", "compare", folder_ / "a", folder_ / "a", "-o", folder_ / "compared"});
  EXPECT_EQ(compared.exit_code, 0) << compared.output;
  EXPECT_THAT(compared.output, HasSubstr("0 of 1200 pairs with different outcomes"));
  EXPECT_TRUE(fs::exists(folder_ / "compared/compare.csv"));
  const std::string result = folder_ / "a";
  for (const std::string table : {"evaluation", "cross-domain", "refinement", "failures", "ransac-ablation"}) {
    const auto made = run_program({"evaluate", "paper", table, result, "-o", folder_ / "tables"});
    EXPECT_EQ(made.exit_code, 0) << made.output;
    EXPECT_TRUE(fs::exists(folder_ / "tables" / (table + ".html")));
  }
  const auto matrix = run_program({"evaluate", "paper", "matrix", "Town:Village=" + result});
  EXPECT_THAT(matrix.output, testing::AllOf(HasSubstr("| Town | Village | 75.00 % |"), HasSubstr("98.97")));
}

TEST_F(EvaluateProgram, SaysWhatIsMissing) {
  EXPECT_EQ(run_program({"evaluate"}).exit_code, 2);
  EXPECT_EQ(run_program({"evaluate", folder_ / "none.txt", "-o", folder_ / "r"}).exit_code, 2);
  const auto no_data =
      run_program({"evaluate", folder_ / "set.txt", "--command", "x=echo ready; sleep 9", "-o", folder_ / "r"});
  EXPECT_EQ(no_data.exit_code, 2);
  EXPECT_THAT(no_data.output, HasSubstr("--data"));
}

}  // namespace
}  // namespace loopmark

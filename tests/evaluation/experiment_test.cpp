// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/experiment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"
#include "loopmark/storage/files.hpp"
#include "pair_sets/pair_files.hpp"

namespace loopmark::evaluation {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// Answers that depend on the pair only; some are wrong, some abstain. May stop the run at one pair.
class MadeUpAlgorithm : public RegistrationAlgorithm {
 public:
  MadeUpAlgorithm(std::string name, const EvaluatedSet& set, std::uint64_t seed)
      : name_(std::move(name)), set_(set), seed_(seed) {}

  const std::string& name() const override { return name_; }
  std::string settings() const override { return "seed " + std::to_string(seed_); }
  bool needs_scans() const override { return false; }

  Answer answer(const PairTask& task) override {
    if (task.index == stop_at) {
      request_interrupt();
      check_interrupt();
    }
    Rng rng(task_seed(seed_, {task.index}));
    Answer answer;
    const bool right = rng.uniform() < 0.7;
    if (right && task.index < set_.pairs.size()) {
      answer.T_target_source = set_.pairs[task.index].T_target_source;
      answer.T_target_source.translation().x() += 0.3 * rng.uniform();
    }
    answer.p_correct = right ? 0.9 : 0.2;
    answer.status = right ? AnswerStatus::kAnswered : AnswerStatus::kAbstained;
    answer.total_seconds = rng.uniform();
    answer.numbers = {{"matches_initial", rng.uniform() * 1000.0}};
    return answer;
  }

  std::size_t stop_at = 1000000;

 private:
  std::string name_;
  const EvaluatedSet& set_;
  std::uint64_t seed_;
};

class ExperimentRun : public testing::Test {
 protected:
  ExperimentRun() {
    task_.set.pairs = test::random_pairs(37, 4);
    task_.set.negatives = {{0, 1, 900, 1}, {1, 2, 901, 0}, {0, 3, 902, 1}};
    task_.set_name = "made-up";
  }
  ~ExperimentRun() override { request_interrupt(false); }

  AlgorithmList algorithms(std::size_t stop_at = 1000000) const {
    AlgorithmList list;
    for (const std::uint64_t seed : {1U, 2U}) {
      auto algorithm = std::make_unique<MadeUpAlgorithm>("a" + std::to_string(seed), task_.set, seed);
      algorithm->stop_at = stop_at;
      list.push_back(std::move(algorithm));
    }
    return list;
  }
  void run(const fs::path& folder, ExperimentTask task, std::size_t stop_at = 1000000) const {
    run_experiment(task, algorithms(stop_at), {}, folder);
  }
  std::string products(const fs::path& folder) const {
    write_products(folder, read_result(folder));
    std::string bytes = storage::read_file(folder / "results.csv") + storage::read_file(folder / "motions/a1.txt");
    for (const char* table : {"overview", "errors", "by_overlap", "certainty", "reliability", "paired"}) {
      bytes += storage::read_file(folder / "tables" / (std::string(table) + ".md"));
    }
    return bytes;
  }

  ExperimentTask task_;
  TemporaryFolder folder_;
};

TEST_F(ExperimentRun, ShardsMergeToTheBytesOfOneRun) {
  run(folder_ / "whole", task_);
  ExperimentTask part = task_;
  for (const std::size_t k : {3U, 1U, 2U}) {
    part.shard = {k, 3};
    part.pairs_at_once = k;
    run(folder_ / "parts", part);
  }
  merge_results({folder_ / "parts"}, folder_ / "parts");
  EXPECT_EQ(products(folder_ / "parts"), products(folder_ / "whole"));
  part.shard = {1, 2};
  run(folder_ / "x", part);
  part.shard = {2, 2};
  run(folder_ / "y", part);
  merge_results({folder_ / "x", folder_ / "y"}, folder_ / "joined");
  EXPECT_EQ(products(folder_ / "joined"), products(folder_ / "whole"));
}

TEST_F(ExperimentRun, MissingShardsAreNamed) {
  task_.shard = {1, 2};
  run(folder_ / "half", task_);
  EXPECT_FALSE(result_is_complete(folder_ / "half"));
  try {
    merge_results({folder_ / "half"}, folder_ / "half");
    FAIL() << "an incomplete result was merged";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("a1 on pair 1"));
    EXPECT_THAT(error.what(), testing::HasSubstr("40 outcomes are missing"));
  }
}

TEST_F(ExperimentRun, InterruptedRunsGoOn) {
  run(folder_ / "whole", task_);
  EXPECT_THROW(run(folder_ / "stopped", task_, 11), Interrupted);
  request_interrupt(false);
  EXPECT_FALSE(result_is_complete(folder_ / "stopped"));
  run(folder_ / "stopped", task_);
  EXPECT_EQ(products(folder_ / "stopped"), products(folder_ / "whole"));
}

TEST_F(ExperimentRun, CutAnywhereItResumesToTheSameBytes) {
  run(folder_ / "whole", task_);
  const std::string expected = products(folder_ / "whole");
  Rng rng(8);
  for (int trial = 0; trial < 20; ++trial) {
    const fs::path folder = folder_ / ("cut" + std::to_string(trial));
    fs::create_directories(folder);
    fs::copy(folder_ / "whole", folder, fs::copy_options::recursive);
    for (const char* name : {"shards/1-of-1.records", "shards/1-of-1.times"}) {
      fs::resize_file(folder / name,
                      static_cast<std::uintmax_t>(rng.uniform() * static_cast<double>(fs::file_size(folder / name))));
    }
    run(folder, task_);
    EXPECT_EQ(products(folder), expected);
  }
}

TEST_F(ExperimentRun, DamageInTheMiddleOfAShardIsToldWithItsLine) {
  run(folder_ / "whole", task_);
  const fs::path file = folder_ / "whole/shards/1-of-1.records";
  std::string content = storage::read_file(file);
  content[content.find('\n') + 30] ^= 1;
  storage::write_file_atomically(file, content);
  try {
    read_result(folder_ / "whole");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("line 2"));
  }
}

TEST_F(ExperimentRun, OutcomesOfPairsThatAreNotThereAreRefused) {
  run(folder_ / "whole", task_);
  const fs::path records = folder_ / "whole/shards/1-of-1.records";
  const std::string good = storage::read_file(records);
  const std::string line = storage::read_records(records).lines.at(2);
  for (const char* pair : {"99999999", "40", "-1", "37"}) {  // 37 is the first negative, the outcome is none
    storage::write_file_atomically(records, good);
    std::string evil = line;
    const std::size_t at = evil.find("\"pair\":") + 7;
    evil.replace(at, evil.find(',', at) - at, pair);
    storage::RecordWriter(records).append(evil);
    EXPECT_THAT([&] { read_result(folder_ / "whole"); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("1-of-1.records:line 81: an outcome of pair")))
        << pair;
    EXPECT_THROW(merge_results({folder_ / "whole"}, folder_ / "merged"), InputError);
  }
}

TEST_F(ExperimentRun, SettingsOfAlgorithmsThatAreNotThereAreRefused) {
  run(folder_ / "whole", task_);
  const fs::path file = folder_ / "whole/experiment.json";
  std::string text = storage::read_file(file);
  const std::size_t at = text.find("\"seed 2\"");
  text.erase(text.rfind(',', at), at + 8 - text.rfind(',', at));
  storage::write_file_atomically(file, text);
  EXPECT_THAT([&] { read_result(folder_ / "whole"); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("settings: there are not as many")));
}

TEST_F(ExperimentRun, AnotherExperimentIsNotMixedIn) {
  run(folder_ / "one", task_);
  task_.criterion.max_translation_m = 0.3;
  EXPECT_THROW(run(folder_ / "one", task_), InputError);
  run(folder_ / "other", task_);
  EXPECT_THROW(merge_results({folder_ / "one", folder_ / "other"}, folder_ / "joined"), InputError);
}

TEST_F(ExperimentRun, SummariesCountWhatHappened) {
  run(folder_ / "whole", task_);
  const StoredResult result = read_result(folder_ / "whole");
  const AlgorithmSummary summary = summarise_all(result.outcomes, {"a1"}, result.set).front();
  EXPECT_EQ(summary.pairs, 37U);
  EXPECT_EQ(summary.negatives, 3U);
  std::size_t successes = 0;
  std::size_t binned = 0;
  for (const Outcome& outcome : result.outcomes) {
    if (outcome.algorithm == "a1" && !outcome.negative) {
      const PoseError error = pose_error(outcome.answer.T_target_source, task_.set.pairs[outcome.pair].T_target_source);
      EXPECT_EQ(outcome.success, error.translation_m < 0.6 && error.rotation_deg < 5.0);
      successes += outcome.success ? 1 : 0;
    }
  }
  for (const RecallBin& bin : summary.by_overlap) {
    binned += bin.successes;
  }
  EXPECT_EQ(summary.successes, successes);
  EXPECT_EQ(binned, successes);
  EXPECT_GT(successes, 15U);
  const PairedTest test = paired_test(result.outcomes, "a1", "a2");
  EXPECT_EQ(test.both + test.only_first + test.only_second + test.neither, 37U);
  EXPECT_EQ(test.both + test.only_first, successes);
}

TEST(Criterion, IsStrict) {
  Answer off;
  off.T_target_source.translation().x() = 0.6;
  EXPECT_FALSE(judge(0, "a", off, Pose::Identity(), {}).success);
  off.T_target_source.translation().x() = 0.5999999;
  EXPECT_TRUE(judge(0, "a", off, Pose::Identity(), {}).success);
  Answer failed;
  failed.status = AnswerStatus::kFailed;
  EXPECT_FALSE(judge(0, "a", failed, Pose::Identity(), {}).success);
}

TEST(ShardText, IsChecked) {
  EXPECT_EQ(shard_from("2/8").index, 2U);
  for (const char* bad : {"0/3", "4/3", "a/b", "1", "1/", "1/2x", ""}) {
    EXPECT_THROW(shard_from(bad), InputError) << bad;
  }
}

/// Two walls and the ground.
PointCloud corner() {
  Rng rng(3);
  PointCloud cloud;
  for (int i = 0; i < 4000; ++i) {
    const double a = rng.uniform(-20.0, 20.0);
    const double b = rng.uniform(0.0, 6.0);
    cloud.points.emplace_back(i % 2 == 0 ? Eigen::Vector3d(a, 8.0, b).cast<float>()
                                         : Eigen::Vector3d(12.0, a, b).cast<float>());
    cloud.points.emplace_back(Eigen::Vector3d(a, rng.uniform(-20.0, 8.0), 0.0).cast<float>());
  }
  return cloud;
}

TEST(Refined, ImprovesAnEarlierAnswer) {
  const PointCloud cloud = corner();
  Pose truth = pose_from_yaw(0.3, {2.0, 1.0, 0.0});
  PairScans scans(cloud, transformed(cloud, truth));
  std::map<std::string, Answer> earlier;
  earlier["base"].T_target_source = pose_from_yaw(0.02, {0.15, 0.1, 0.05}) * truth;
  for (const std::string& method : refinement_methods()) {
    const auto refined = make_refined_algorithm("base", method);
    EXPECT_EQ(refined->name(), "base+" + method);
    const Answer answer = refined->answer({0, {}, &scans, nullptr, &earlier});
    EXPECT_LT(pose_error(answer.T_target_source, truth).translation_m, 0.05) << method;
  }
  EXPECT_THROW(make_refined_algorithm("base", "nothing"), InputError);
}

TEST(NamedAlgorithm, RunsThePapersPipelineWithItsOwnSeed) {
  for (const char* name : {"ransac_mutual", "ransac_gpf#2", "gnc_clique"}) {
    EXPECT_EQ(make_named_algorithm(name)->name(), name);
  }
  EXPECT_NE(make_named_algorithm("ransac_mutual#1")->settings(), make_named_algorithm("ransac_mutual#2")->settings());
  EXPECT_THROW(make_named_algorithm("nothing"), InputError);
  EXPECT_THROW(make_named_algorithm("ransac_mutual#x"), InputError);
}

double seconds_of(const Answer& answer, const std::string& stage) {
  for (const registration::StageTime& time : answer.timings) {
    if (time.stage == stage) {
      return time.seconds;
    }
  }
  return -1.0;
}

TEST(NamedAlgorithm, DescribesAndMatchesAPairOnceForAllThatDescribeAlike) {
  PairScans scans(corner(), transformed(corner(), pose_from_yaw(0.3, {2.0, 1.0, 0.0})));
  const PairTask task{0, {}, &scans, nullptr, nullptr};
  const Answer first = make_named_algorithm("ransac_mutual")->answer(task);
  const Answer second = make_named_algorithm("gnc_clique")->answer(task);
  const Answer other = make_named_algorithm("gnc_clique_no_ground")->answer(task);
  for (const char* stage : {"descriptors", "nearest"}) {
    EXPECT_GT(seconds_of(first, stage), 0.0) << stage;
    EXPECT_EQ(seconds_of(first, stage), seconds_of(second, stage)) << "the same measured time: it was taken once";
    EXPECT_NE(seconds_of(first, stage), seconds_of(other, stage)) << stage;
  }
}

TEST(ConfiguredAlgorithm, DoesWhatTheNamedOneOfItsOptionsDoes) {
  PairScans scans(corner(), transformed(corner(), pose_from_yaw(0.3, {2.0, 1.0, 0.0})));
  const PairTask task{0, {}, &scans, nullptr, nullptr};
  const auto custom =
      make_configured_algorithm("custom", feature_registration::named_algorithm("gnc_core"), "options\n");
  EXPECT_EQ(custom->name(), "custom");
  EXPECT_THAT(custom->settings(), testing::HasSubstr("options\n"));
  EXPECT_EQ(custom->answer(task).T_target_source.matrix(),
            make_named_algorithm("gnc_core")->answer(task).T_target_source.matrix());
  feature_registration::FeatureRegistrationOptions bad;
  bad.voxel_m = 0.0;
  EXPECT_THROW(make_configured_algorithm("custom", bad, ""), InputError);
}

}  // namespace
}  // namespace loopmark::evaluation

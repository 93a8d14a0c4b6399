// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/external_algorithm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"
#include "pair_sets/pair_files.hpp"

namespace loopmark::evaluation {
namespace {

using testing::HasSubstr;

/// A shell script that plays a competitor; `body` runs for each pair with $source and $target set.
class Competitor {
 public:
  explicit Competitor(const std::string& body) {
    std::ofstream(folder_ / "program.sh") << "read greeting\necho ready test\nwhile read word source target; do\n"
                                          << "  [ \"$word\" = quit ] && exit 0\n  " << body << "\ndone\n";
  }
  std::unique_ptr<RegistrationAlgorithm> start(double limit_s = 5.0) const {
    return make_external_algorithm("test", {"sh " + (folder_ / "program.sh").string(), limit_s, 5.0, folder_.path()});
  }
  std::size_t files_left() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      count += entry.path().extension() == ".bin" ? 1 : 0;
    }
    return count;
  }

 private:
  test::TemporaryFolder folder_;
};

Answer ask(RegistrationAlgorithm& algorithm, std::size_t index = 0) {
  PointCloud cloud;
  cloud.points = {{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
  PairScans scans(cloud, cloud);
  return algorithm.answer({index, {}, &scans, nullptr, nullptr});
}

TEST(ExternalAlgorithm, AnswersWithAMotionAScoreAndItsTime) {
  const Competitor competitor("test -s $source && echo motion 1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1 0.75 0.125");
  const auto algorithm = competitor.start();
  for (std::size_t i = 0; i < 3; ++i) {
    const Answer answer = ask(*algorithm, i);
    EXPECT_EQ(answer.status, AnswerStatus::kAnswered) << answer.note;
    EXPECT_EQ(answer.T_target_source.translation(), Eigen::Vector3d(4, 5, 6));
    EXPECT_DOUBLE_EQ(answer.p_correct, 0.75);
    EXPECT_DOUBLE_EQ(answer.paper_seconds, 0.125);
    EXPECT_GT(answer.total_seconds, 0.0);
  }
  EXPECT_EQ(competitor.files_left(), 0U);
}

TEST(ExternalAlgorithm, GetsTheCloudsAsFloats) {
  const Competitor competitor("echo failed $(stat -c %s $source) $(stat -c %s $target)");
  const Answer answer = ask(*competitor.start());
  EXPECT_EQ(answer.status, AnswerStatus::kFailed);
  EXPECT_EQ(answer.note, "32 32");
}

TEST(ExternalAlgorithm, ThatDiesIsStartedAnew) {
  const Competitor competitor("case $source in */1-source.bin) exit 3;; esac; echo failed quietly");
  const auto algorithm = competitor.start();
  EXPECT_EQ(ask(*algorithm, 0).status, AnswerStatus::kFailed);
  const Answer dead = ask(*algorithm, 1);
  EXPECT_EQ(dead.status, AnswerStatus::kCrashed);
  EXPECT_THAT(dead.note, HasSubstr("exit code 3"));
  EXPECT_EQ(ask(*algorithm, 2).status, AnswerStatus::kFailed);
}

TEST(ExternalAlgorithm, ThatHangsRunsIntoTheTimeLimit) {
  const Competitor competitor("sleep 60");
  const auto algorithm = competitor.start(0.3);
  const Stopwatch watch;
  EXPECT_EQ(ask(*algorithm).status, AnswerStatus::kTimeLimit);
  EXPECT_LT(watch.seconds(), 5.0);
}

TEST(ExternalAlgorithm, ThatTalksNonsenseCountsAsCrashed) {
  for (const char* line :
       {"hello world", "motion 1 2 3", "motion 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0.5 x",
        "motion 2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0.5 0.1", "motion nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0.5 0.1"}) {
    const Competitor competitor(std::string("echo ") + line);
    const Answer answer = ask(*competitor.start());
    EXPECT_EQ(answer.status, AnswerStatus::kCrashed) << line;
    EXPECT_THAT(answer.note, HasSubstr("nonsense"));
    EXPECT_EQ(answer.T_target_source.matrix(), Eigen::Matrix4d::Identity());
  }
}

TEST(ExternalAlgorithm, ThatDoesNotStartIsToldAtOnce) {
  EXPECT_THROW(make_external_algorithm("x", {"/no/such/program", 1.0, 5.0, {}}), InputError);
  EXPECT_THROW(make_external_algorithm("x", {"echo hello", 1.0, 5.0, {}}), InputError);
  EXPECT_THROW(make_external_algorithm("x", {"sleep 10", 1.0, 0.2, {}}), InputError);
}

}  // namespace
}  // namespace loopmark::evaluation

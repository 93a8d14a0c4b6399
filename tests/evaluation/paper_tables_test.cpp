// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/paper_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "loopmark/evaluation/paper_numbers.hpp"
#include "pair_sets/pair_files.hpp"

namespace loopmark::evaluation {
namespace {

/// Twenty pairs on which algorithm k is right except for every (k + 2)th pair, in k + 1 seconds.
StoredResult made_up_result(const std::vector<std::string>& algorithms) {
  StoredResult result;
  result.set.pairs = test::random_pairs(20, 1);
  result.experiment.algorithms = algorithms;
  result.experiment.set_name = "made-up";
  for (std::size_t a = 0; a < algorithms.size(); ++a) {
    for (std::size_t i = 0; i < 20; ++i) {
      Answer answer;
      answer.T_target_source = result.set.pairs[i].T_target_source;
      answer.T_target_source.translation().x() += i % (a + 2) == 0 ? 3.0 : 0.0;
      answer.paper_seconds = static_cast<double>(a + 1);
      answer.numbers = {{"matches_initial", 1000.0}, {"matches_mutual", 100.0}};
      result.outcomes.push_back(judge(i, algorithms[a], answer, result.set.pairs[i].T_target_source, {}));
    }
  }
  return result;
}

TEST(ConvexHull, OfASquareWithPointsInsideAndOnItsEdges) {
  const auto hull = convex_hull({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.5, 0.0}, {0, 0}});
  ASSERT_EQ(hull.size(), 4U);
  double twice_area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const RunPoint& a = hull[i];
    const RunPoint& b = hull[(i + 1) % 4];
    twice_area += a.seconds * b.recall - b.seconds * a.recall;
  }
  EXPECT_DOUBLE_EQ(twice_area, 2.0);
}

TEST(ConvexHull, OfFewPointsIsThem) {
  EXPECT_EQ(convex_hull({{1, 2}}).size(), 1U);
  EXPECT_EQ(convex_hull({{1, 2}, {0, 0}}).size(), 2U);
  EXPECT_EQ(convex_hull({{0, 0}, {1, 1}, {2, 2}}).size(), 2U);
}

TEST(Variants, GatherTheRepeatsOfAName) {
  const auto variants = variants_of(made_up_result({"a#1", "a#2", "a#3", "a#1+icp", "b"}));
  ASSERT_EQ(variants.size(), 3U);
  EXPECT_EQ(variants[0].name, "a");
  EXPECT_EQ(variants[0].runs.size(), 3U);
  EXPECT_EQ(variants[1].name, "a+icp");
  EXPECT_DOUBLE_EQ(variants[0].mean.seconds, 2.0);
  EXPECT_NEAR(variants[0].mean.recall, (10.0 + 13.0 + 15.0) / 60.0, 1e-12);
}

TEST(EvaluationTable, PutsIcpBesideItsAlgorithmAndThePaperBelow) {
  const text::TextTable table = paper_evaluation_table(made_up_result({"x", "x+icp"}), false);
  ASSERT_EQ(table.rows.size(), 1U + paper::evaluation().size());
  EXPECT_THAT(table.rows[0], testing::ElementsAre("x", "50.00 %", "1.000", "65.00 %", "2.000"));
  EXPECT_THAT(table.rows.back(),
              testing::ElementsAre("RANSAC (GPF) (paper, NuScenes-Boston)", "86.88 %", "0.199", "91.90 %", "0.257"));
}

TEST(MatrixTable, SplitsTrainDomains) {
  const StoredResult result = made_up_result({"x@Boston", "x@Boston+icp", "x@Apollo", "y"});
  const auto domains = split_by_domain("Town", "-", result);
  ASSERT_EQ(domains.size(), 3U);
  EXPECT_THAT(domains[0].result.experiment.algorithms, testing::ElementsAre("x", "x+icp"));
  const text::TextTable table = paper_matrix_table(domains);
  EXPECT_EQ(table.rows[0][1], "Boston");
  EXPECT_EQ(table.rows[0][2], "50.00 %");
  EXPECT_EQ(table.rows[1][2], "75.00 %");
  EXPECT_EQ(table.rows.size(), 3U + 9U);
  EXPECT_THAT(paper_match_sizes_table(domains).rows[0], testing::ElementsAre("Town", "Boston", "1000", "100"));
}

TEST(FailureTable, CountsEveryPairOnceForEachQuantity) {
  const auto histograms = failure_histograms(made_up_result({"x"}), "x");
  for (const FailureHistogram& histogram : histograms) {
    std::size_t successes = 0;
    std::size_t failures = 0;
    for (std::size_t i = 0; i < histogram.successes.size(); ++i) {
      successes += histogram.successes[i];
      failures += histogram.failures[i];
    }
    EXPECT_EQ(successes, 10U) << histogram.quantity;
    EXPECT_EQ(failures, 10U) << histogram.quantity;
  }
}

TEST(TextTables, EscapeWhatMarkdownAndLatexWouldRead) {
  const text::TextTable table{"t", "50 % of a_b", {"a|b", "c"}, {{"x & y", "1 %"}}, ""};
  EXPECT_THAT(text::to_markdown(table), testing::HasSubstr("| a\\|b | c |"));
  EXPECT_THAT(text::to_latex(table),
              testing::AllOf(testing::HasSubstr("50 \\% of a\\_b"), testing::HasSubstr("x \\& y & 1 \\% \\\\")));
}

}  // namespace
}  // namespace loopmark::evaluation

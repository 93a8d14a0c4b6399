// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_page/answers.hpp"

#include <gtest/gtest.h>

#include "map_page/sample_runs.hpp"

namespace loopmark::map_page {
namespace {

TEST(Answers, WrongOnesAreSaidFirst) {
  const std::vector<Finding> all = findings(*testing_support::answered_run().answers);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].severity, Severity::kProblem);
  EXPECT_EQ(all[0].text, "1 of 5 (20.0 %) answers are wrong; the surest first:");
  ASSERT_EQ(all[0].links.size(), 1U);
  EXPECT_EQ(all[0].links[0].text, "scan 50");
  EXPECT_EQ(all[0].links[0].kind, LinkKind::kAnswer);
  EXPECT_EQ(all[0].links[0].first, 5U);
}

TEST(Answers, StretchesWithoutAPositionAreNamedWithTheirLength) {
  const std::vector<Finding> all = findings(*testing_support::answered_run().answers);
  EXPECT_EQ(all[1].text, "2 of 7 (28.6 %) got no position; the longest in a row:");
  ASSERT_EQ(all[1].links.size(), 1U);
  EXPECT_EQ(all[1].links[0].text, "scan 20 (2)");
}

TEST(Answers, WithoutTruthNothingIsCalledRight) {
  AnswerLayer layer = *testing_support::answered_run().answers;
  for (Answer& answer : layer.answers) {
    answer.truth.setConstant(std::nan(""));
    answer.wrong = false;
  }
  const std::vector<Finding> all = findings(layer);
  EXPECT_EQ(all[0].text, "The truth is not known: nothing says whether the answers are right.");
}

}  // namespace
}  // namespace loopmark::map_page

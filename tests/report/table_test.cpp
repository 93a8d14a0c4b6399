// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace loopmark::report {
namespace {

using testing::HasSubstr;

Table sample() {
  Table table({"name", "recall", "pairs"}, "A & B");
  table.row({"a|b_c", percent_cell(0.9136), count_cell(250)});
  table.row({"say \"x\", <y>", percent_cell(std::numeric_limits<double>::quiet_NaN()), count_cell(7)});
  return table;
}

TEST(Table, Markdown) {
  EXPECT_EQ(sample().markdown(),
            "A & B\n\n| name | recall | pairs |\n|---|---:|---:|\n| a\\|b_c | 91.4 % | 250 |\n"
            "| say \"x\", <y> | \u2013 | 7 |\n");
}

TEST(Table, Latex) {
  EXPECT_THAT(sample().latex(), HasSubstr("\\begin{tabular}{lrr}\n\\toprule\nname & recall & pairs \\\\\n\\midrule\n"
                                          "a|b\\_c & 91.4 \\% & 250 \\\\\n"));
  EXPECT_THAT(sample().latex(), HasSubstr("\\caption{A \\& B}"));
}

TEST(Table, HtmlKeepsTheNumbersBehindTheTexts) {
  EXPECT_THAT(sample().html(), HasSubstr("<td class=\"number\" data-sort=\"0.913600000\">91.4 %</td>"));
  EXPECT_THAT(sample().html(), HasSubstr("<td>say &quot;x&quot;, &lt;y&gt;</td><td class=\"number\">\u2013</td>"));
}

TEST(Table, CsvQuotesWhereItMust) {
  EXPECT_EQ(sample().csv(), "name,recall,pairs\na|b_c,91.4 %,250\n\"say \"\"x\"\", <y>\",\u2013,7\n");
}

TEST(Table, TextIsAligned) {
  EXPECT_EQ(sample().text(),
            "name          recall  pairs\na|b_c         91.4 %    250\nsay \"x\", <y>       \u2013      7\n");
}

TEST(Table, RefusesRowsOfTheWrongLength) { EXPECT_THROW(Table({"a", "b"}).row({"only one"}), std::invalid_argument); }

TEST(Cells, NumbersAreRoundedNotTruncated) {
  EXPECT_EQ(number_cell(-0.0004, 2).text, "0.00");
  EXPECT_EQ(number_cell(1.006, 2).text, "1.01");
  EXPECT_EQ(percent_cell(0.5, 0).text, "50 %");
}

}  // namespace
}  // namespace loopmark::report

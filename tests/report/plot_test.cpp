// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>

namespace loopmark::report {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++times;
  }
  return times;
}

/// The points of the first path of a colour.
std::vector<std::pair<double, double>> path_points(const std::string& svg, Colour colour) {
  const std::regex path("<path d=\"([^\"]*)\"[^>]*" + hex(colour));
  std::smatch found;
  std::vector<std::pair<double, double>> points;
  if (std::regex_search(svg, found, path)) {
    const std::string d = found[1];
    const std::regex point("[ML]([-0-9.]+) ([-0-9.]+)");
    for (std::sregex_iterator i(d.begin(), d.end(), point), end; i != end; ++i) {
      points.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
    }
  }
  return points;
}

TEST(Plot, LineIsDrawnTrueToScale) {
  Plot plot("title", "x", "y");
  plot.x_range(0, 10).y_range(0, 4).line("a", {0, 5, 10}, {0, 4, 2});
  const auto points = path_points(plot.svg(), palette(0));
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR(points[1].first - points[0].first, points[2].first - points[1].first, 0.02);
  EXPECT_NEAR(points[0].second - points[1].second, 2.0 * (points[2].second - points[1].second), 0.02);
}

TEST(Plot, ALongLegendMakesThePlotHigherNotItsAxesShorter) {
  const auto drop = [](std::size_t lines) {
    Plot plot("title", "x", "y");
    plot.y_range(0, 1).line("the first", {0, 1}, {0, 1});
    for (std::size_t i = 1; i < lines; ++i) {
      plot.line("an algorithm with a name " + std::to_string(i), {0, 1}, {0.5, 0.5});
    }
    const auto points = path_points(plot.svg(), palette(0));
    return points.at(0).second - points.at(1).second;
  };
  EXPECT_GT(drop(40), 0.9 * drop(1));
}

TEST(Plot, EqualAxesKeepAnglesOfTheWorld) {
  Plot plot("", "x", "y");
  plot.equal_axes().line("square", {0, 30, 30}, {0, 0, 30});
  const auto points = path_points(plot.svg(), palette(0));
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR(points[1].first - points[0].first, points[1].second - points[2].second, 0.03);
}

TEST(Plot, LogarithmicAxisSpacesPowersEvenly) {
  Plot plot("", "x", "y");
  plot.log_y().line("a", {0, 1, 2, 3}, {1e-3, 1e-1, 10, 0.0});
  const auto points = path_points(plot.svg(), palette(0));
  ASSERT_EQ(points.size(), 3U) << "zero cannot be shown";
  EXPECT_NEAR(points[0].second - points[1].second, points[1].second - points[2].second, 0.03);
}

TEST(Plot, ValuesThatAreNotFiniteLeaveAGap) {
  Plot plot("", "x", "y");
  plot.line("a", {0, 1, 2, 3, 4}, {0, 1, kNan, 1, 0});
  EXPECT_EQ(count(plot.svg(), "M"), 2U);
  EXPECT_THAT(plot.svg(), Not(HasSubstr("nan")));
}

TEST(Plot, NothingToShowIsAnEmptyPlot) {
  EXPECT_THAT(Plot("t", "x", "y").svg(), HasSubstr("</svg>"));
  Plot plot("t", "x", "y");
  plot.line("a", {}, {}).points("b", {kNan}, {1.0}).log_y();
  EXPECT_THAT(plot.svg(), Not(HasSubstr("nan")));
  EXPECT_THAT(plot.svg(), Not(HasSubstr("inf")));
}

TEST(Plot, EverySeriesStandsInTheLegendAndIsEscaped) {
  Plot plot("a < b", "x & y", "\"q\"");
  plot.line("first", {0, 1}, {0, 1}).points("second <1>", {0, 1}, {1, 2}).bars("third", {0, 1, 2}, {3, 4});
  plot.line("", {0, 1}, {0, 1});
  const std::string svg = plot.svg();
  EXPECT_THAT(svg, HasSubstr(">first<"));
  EXPECT_THAT(svg, HasSubstr(">second &lt;1&gt;<"));
  EXPECT_THAT(svg, HasSubstr(">third<"));
  EXPECT_THAT(svg, HasSubstr(">a &lt; b<"));
  EXPECT_THAT(svg, HasSubstr(">x &amp; y<"));
}

TEST(Plot, SameContentGivesTheSameBytes) {
  const auto make = [] {
    Plot plot("t", "x", "y");
    plot.heat_map("h", {0, 1, kNan, 2}, 2, {0, 2, 0, 2}).coloured_points("c", {0, 1}, {0, 1}, {3, 4});
    plot.band("b", {0, 1, 2}, {0, 0, 0}, {1, kNan, 1}).intervals("i", {0}, {1}, {2}).polygon("p", {0, 1, 1}, {0, 0, 1});
    plot.segments("s", {0, 1, 1, 2}, {0, 1, 1, 0}).text("here", 1, 1);
    return plot.svg();
  };
  EXPECT_EQ(make(), make());
}

TEST(Plot, RefusesVectorsThatDiffer) {
  Plot plot("t", "x", "y");
  EXPECT_THROW(plot.line("a", {0, 1}, {0}), std::invalid_argument);
  EXPECT_THROW(plot.bars("a", {0, 1}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(plot.heat_map("a", {0, 1, 2}, 2, {0, 1, 0, 1}), std::invalid_argument);
}

TEST(Histogram, CountsEveryValueInRangeOnce) {
  const Histogram h = histogram({0.0, 0.1, 0.5, 0.99, 1.0, 2.0, -1.0, kNan}, 0.0, 1.0, 2);
  EXPECT_EQ(h.edges, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(h.counts, (std::vector<double>{2.0, 3.0}));
  EXPECT_THROW(histogram({}, 1.0, 1.0, 2), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::report

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "loopmark/core/random.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::report {
namespace {

using testing::HasSubstr;

std::vector<double> wave(std::size_t count, double phase) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(40.0 * std::sin(0.05 * static_cast<double>(i) + phase));
  }
  return values;
}

std::vector<double> steps(std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(static_cast<double>(i));
  }
  return values;
}

/// A wall, a few poles and the ground, seen by a car.
std::vector<Eigen::Vector3f> street(Rng& rng) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 4000; ++i) {
    const double along = rng.uniform(-40.0, 40.0);
    points.emplace_back(Eigen::Vector3d(along, 8.0, rng.uniform(-1.7, 6.0)).cast<float>());
    points.emplace_back(Eigen::Vector3d(along, rng.uniform(-12.0, 8.0), -1.7).cast<float>());
    points.emplace_back(Eigen::Vector3d(10.0 * std::round(along / 10.0), -6.0, rng.uniform(-1.7, 4.0)).cast<float>());
  }
  return points;
}

/// A page with every kind of content.
Page sample_page() {
  const std::vector<double> t = steps(200);
  Plot path("Trajectory", "x [m]", "y [m]");
  path.equal_axes().line("odometry", wave(200, 0.0), wave(200, 1.5)).line("with loops", wave(200, 0.1), wave(200, 1.4));
  path.segments("loops", {-40, -20, 10, 30}, {0, 10, -20, 5}, {.width = 1.0, .dashed = true});
  Plot time("Time per scan", "scan", "time [ms]");
  time.log_y().line("registration", t, std::vector<double>(200, 12.0)).points("odometry", t, [&] {
    std::vector<double> y;
    for (const double i : t) {
      y.push_back(3.0 + std::fmod(i * 7.7, 31.0));
    }
    return y;
  }());
  Plot recall("Recall by algorithm", "", "recall [%]");
  recall.categories({"RANSAC (mutual)", "RANSAC (GPF)", "spatial consistency", "loopmark"});
  recall.category_bars("algorithm alone", {61, 74, 70, 96}).category_bars("with ICP", {89, 92, 91, 98});
  recall.y_range(0, 100);
  Plot errors("Errors", "TE [m]", "pairs");
  const Histogram h = histogram(wave(200, 0.3), -40.0, 40.0, 20);
  errors.bars("all", h.edges, h.counts);
  Plot calibration("Reliability", "P(correct)", "share right");
  calibration.line("ideal", {0, 1}, {0, 1}, {.colour = kGrey, .dashed = true});
  calibration.band("95 %", {0.1, 0.5, 0.9}, {0.0, 0.35, 0.8}, {0.2, 0.6, 0.97});
  calibration.intervals("bins", {0.1, 0.5, 0.9}, {0.02, 0.4, 0.85}, {0.18, 0.55, 0.95});
  Plot heat("Overlap", "x [m]", "y [m]");
  heat.heat_map("overlap", wave(600, 0.0), 30, {-15, 15, -10, 10});
  Plot hull("Recall against time", "time [ms]", "recall [%]");
  hull.polygon("PROSAC", {10, 30, 40, 20}, {80, 82, 90, 92}).polygon("uniform", {25, 60, 70, 40}, {70, 74, 85, 84});
  hull.coloured_points("iterations", {15, 25, 45}, {83, 87, 80}, {10, 100, 1000});
  Table table({"algorithm", "pairs", "recall", "time [ms]"}, "Each algorithm on one set.");
  table.row({"loopmark", count_cell(250), percent_cell(0.96), number_cell(118.4, 1)});
  table.row({"RANSAC <GPF>", count_cell(250), percent_cell(0.74), number_cell(199.0, 1)});
  Rng rng(7);
  const auto target = street(rng);
  const Pose motion = pose_from_yaw(0.3, {5.0, 1.0, 0.0});
  std::vector<Eigen::Vector3f> source;
  for (const auto& point : street(rng)) {
    source.push_back((motion.inverse() * point.cast<double>()).cast<float>());
  }
  Page page("A report & more", "made by a test");
  page.facts({{"scans", "154"}, {"loops", "3"}, {"recall", "96.0 %"}});
  page.heading("Plots").plots({path, time}).plots({recall, errors}).plots({calibration, heat}).plot(hull, "A caption.");
  page.heading("Table").paragraph("Click on a name to sort; a < b.").table(table);
  page.heading("Pictures").picture(registration_picture(source, target, motion, 1000), "before and after");
  page.details("More", Page("").code("loopmark map LOG -o RUN"));
  return page;
}

TEST(Page, RefersToNothingOutsideItself) {
  const std::string html = sample_page().html();
  for (const std::string reference : {"src=\"", "href=\"", "url("}) {
    for (std::size_t at = html.find(reference); at != std::string::npos; at = html.find(reference, at + 1)) {
      const std::string target = html.substr(at + reference.size(), 40);
      EXPECT_TRUE(target.front() == '#' || target.rfind("data:image/png;base64,", 0) == 0) << target;
    }
  }
  EXPECT_THAT(html, Not(HasSubstr("<link")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
}

TEST(Page, EscapesAndLinksItsHeadings) {
  const std::string html = sample_page().html();
  EXPECT_THAT(html, HasSubstr("<title>A report &amp; more</title>"));
  EXPECT_THAT(html, HasSubstr("<a href=\"#Table\">Table</a>"));
  EXPECT_THAT(html, HasSubstr("<h2 id=\"Table\">"));
  EXPECT_THAT(html, HasSubstr("a &lt; b."));
}

TEST(Page, SameContentGivesTheSameBytes) {
  const std::string html = sample_page().html();
  EXPECT_EQ(html, sample_page().html());
  // Left behind to be looked at.
  storage::write_file_atomically(std::filesystem::path(testing::TempDir()) / "loopmark_sample_page.html", html);
}

}  // namespace
}  // namespace loopmark::report

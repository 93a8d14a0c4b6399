// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/search/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "loopmark/core/random.hpp"

namespace loopmark::search {
namespace {

std::vector<Eigen::Vector3f> random_points(std::size_t count, double half, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& p : points) {
    p = Eigen::Vector3d(rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(-half, half)).cast<float>();
  }
  return points;
}

TEST(CellGrid, NearestIsTheBruteForceOne) {
  const auto points = random_points(800, 5.0, 1);
  for (const float cell : {0.3F, 1.0F, 2.7F}) {
    const CellGrid grid(points, cell);
    for (const Eigen::Vector3f& q : random_points(300, 6.0, 2)) {
      const float limit = 0.81F;
      float best = limit;
      std::size_t expected = points.size();
      for (std::size_t i = 0; i < points.size(); ++i) {
        if ((points[i] - q).squaredNorm() < best) {
          best = (points[i] - q).squaredNorm();
          expected = i;
        }
      }
      const auto found = grid.nearest(q, limit);
      ASSERT_EQ(found.has_value(), expected < points.size());
      if (found) {
        EXPECT_EQ(grid.index()[found->place], expected);
      }
    }
  }
}

TEST(CellGrid, WithinFindsEveryPoint) {
  const auto points = random_points(600, 4.0, 3);
  const CellGrid grid(points, 0.7F);
  for (const Eigen::Vector3f& q : random_points(100, 4.0, 4)) {
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - q).squaredNorm() < 1.5F * 1.5F) {
        expected.push_back(static_cast<std::uint32_t>(i));
      }
    }
    std::vector<std::uint32_t> found;
    grid.within(q, 1.5F, [&](std::uint32_t place, float) { found.push_back(grid.index()[place]); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(CellGrid, RunsAroundACellHoldItsWholeNeighbourhood) {
  const auto points = random_points(500, 3.0, 5);
  const CellGrid grid(points, 0.9F);
  std::vector<CellGrid::Run> runs;
  for (const CellGrid::Cell& cell : grid.cells()) {
    grid.runs_around(cell, runs);
    std::vector<bool> covered(grid.size(), false);
    for (const CellGrid::Run& run : runs) {
      std::fill(covered.begin() + run.begin, covered.begin() + run.end, true);
    }
    for (std::uint32_t i = cell.run.begin; i < cell.run.end; ++i) {
      for (std::uint32_t j = 0; j < grid.size(); ++j) {
        if ((grid.point(i) - grid.point(j)).norm() < 0.9F) {
          ASSERT_TRUE(covered[j]);
        }
      }
    }
  }
}

TEST(CellGrid, EqualDistancesGoToTheLowestIndex) {
  const CellGrid grid({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, 1.0F);
  EXPECT_EQ(grid.index()[grid.nearest({0, 0, 0}, 4.0F)->place], 0U);
}

TEST(CellGrid, LeavesOutPointsThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const CellGrid grid({{nan, 0, 0}, {1, 2, 3}}, 0.5F);
  EXPECT_EQ(grid.size(), 1U);
  EXPECT_FALSE(grid.nearest({nan, 0, 0}, 1.0F));
  EXPECT_FALSE(CellGrid({}, 1.0F).nearest({0, 0, 0}, 1.0F));
}

TEST(CellGrid, RefusesACellThatCannotHoldThePoints) {
  EXPECT_THROW(CellGrid({{0, 0, 0}}, 0.0F), std::invalid_argument);
  EXPECT_THROW(CellGrid({{1e9F, 0, 0}}, 0.1F), std::invalid_argument);
}

}  // namespace
}  // namespace loopmark::search

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/structure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "loopmark/core/random.hpp"

namespace loopmark::bev {
namespace {

/// Level ground, 0.1 m apart, with a kerb of 0.12 m along the line y = 3.1.
std::vector<Eigen::Vector3f> kerb() {
  std::vector<Eigen::Vector3f> points;
  for (int i = -200; i <= 200; ++i) {
    for (int j = -200; j <= 200; ++j) {
      points.emplace_back(0.1F * static_cast<float>(i) + 0.05F, 0.1F * static_cast<float>(j) + 0.05F,
                          j > 30 ? 0.12F : 0.0F);
    }
  }
  return points;
}

TEST(ReliefCells, AreTheMeanHeightLessThatOfTheGroundAround) {
  const auto points = kerb();
  const auto cells = relief_cells(points, GroundMap());
  ASSERT_FALSE(cells.empty());
  for (const ReliefCell& cell : cells) {
    if (std::abs(cell.x) > 10.0F || cell.y < -1.0F || cell.y > 7.0F) {
      continue;
    }
    // By hand: the mean over the window of kReliefRadius to either side, in steps of the cells.
    const float edge = std::floor(kReliefRadius / kStructureCell) * kStructureCell + 0.5F * kStructureCell;
    double sum = 0.0;
    double count = 0.0;
    double own = 0.0;
    double own_count = 0.0;
    for (int j = -200; j <= 200; ++j) {
      const float y = 0.1F * static_cast<float>(j) + 0.05F;
      const double z = j > 30 ? 0.12 : 0.0;
      if (y > cell.y - edge - 1e-3F && y < cell.y + edge - 1e-3F) {
        sum += z;
        count += 1.0;
      }
      if (std::abs(y - cell.y) < 0.5F * kStructureCell) {
        own += z;
        own_count += 1.0;
      }
    }
    EXPECT_NEAR(cell.relief, own / own_count - sum / count, 0.02) << cell.y;
  }
}

TEST(ReliefCells, LeaveOutWhatStandsAboveTheGround) {
  EXPECT_TRUE(relief_cells({{5.0F, 0.0F, 1.0F}, {6.0F, 0.0F, 2.0F}}, GroundMap()).empty());
}

TEST(StructureCells, KnowTheirHeightBands) {
  const auto cells =
      structure_cells({{5.1F, 0.1F, 0.2F}, {5.1F, 0.1F, 1.0F}, {5.2F, 0.2F, 4.0F}, {9.0F, 0.0F, 2.0F}}, GroundMap());
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_EQ(cells[0].bands, 0b101);
  EXPECT_EQ(cells[1].bands, 0b010);
}

}  // namespace
}  // namespace loopmark::bev

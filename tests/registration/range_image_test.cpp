// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/range_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace loopmark::registration {
namespace {

Eigen::Vector3f towards(double azimuth_deg, double elevation_deg, double range) {
  const double a = azimuth_deg * std::numbers::pi / 180.0;
  const double e = elevation_deg * std::numbers::pi / 180.0;
  return (range * Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e))).cast<float>();
}

/// A wall at 20 m over 41 x 21 degrees, with a pole at 8 m in the middle column where asked.
RangeImage wall(bool pole) {
  std::vector<Eigen::Vector3f> points;
  for (int azimuth = -20; azimuth <= 20; ++azimuth) {
    for (int elevation = -10; elevation <= 10; ++elevation) {
      points.push_back(towards(azimuth + 0.5, elevation + 0.5, pole && azimuth == 0 ? 8.0 : 20.0));
    }
  }
  return RangeImage(points);
}

TEST(RangeImage, TellsWhatABeamSaysOfAPoint) {
  const RangeImage image = wall(false);
  using Sight = RangeImage::Sight;
  EXPECT_EQ(image.look_at(towards(5.5, 2.5, 20.1), 0.5F), Sight::kAgrees);
  EXPECT_EQ(image.look_at(towards(5.5, 2.5, 25.0), 0.5F), Sight::kHidden);
  EXPECT_EQ(image.look_at(towards(90.0, 2.5, 10.0), 0.5F), Sight::kUnknown);
  EXPECT_EQ(image.look_at(towards(5.5, 2.5, 10.0), 0.5F), Sight::kStrongViolation);
}

TEST(RangeImage, BesideAnEdgeAConflictIsNoClash) {
  const RangeImage image = wall(true);
  EXPECT_EQ(image.look_at(towards(1.5, 2.5, 10.0), 0.5F), RangeImage::Sight::kFreeSpaceViolation);
  EXPECT_EQ(image.look_at(towards(2.5, 2.5, 10.0), 0.5F), RangeImage::Sight::kStrongViolation);
}

}  // namespace
}  // namespace loopmark::registration

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "loopmark/mapping/solved_map.hpp"

namespace loopmark::mapping {
namespace {

constexpr double kGap_m = 40.0;

Keyframe at(double path_m, double x, double y) {
  Keyframe keyframe;
  keyframe.path_m = path_m;
  keyframe.T_segment_lidar = pose_from_yaw(0.0, {x, y, 0.0});
  return keyframe;
}

TEST(ComesBack, AlongAStreetOnlyBeyondTheGap) {
  EXPECT_FALSE(is_revisit(at(0, 0, 0), at(39, 39, 0), kGap_m));
  EXPECT_TRUE(is_revisit(at(0, 0, 0), at(41, 41, 0), kGap_m));
}

TEST(ComesBack, ATurnWithinAHallIsARevisitSooner) {
  EXPECT_TRUE(is_revisit(at(41, 0, 0), at(72, 4, 1), kGap_m));
  EXPECT_FALSE(is_revisit(at(41, 0, 0), at(72, 20, 1), kGap_m)) << "hardly a detour";
  EXPECT_FALSE(is_revisit(at(41, 0, 0), at(55, 1, 0), kGap_m)) << "the local map still knows it";
}

}  // namespace
}  // namespace loopmark::mapping

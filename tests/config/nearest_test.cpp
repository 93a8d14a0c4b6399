// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/config/nearest.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace loopmark::config {
namespace {

/// The definition, by recursion.
std::size_t slow_distance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) {
    return a.size() + b.size();
  }
  const std::string a1 = a.substr(1);
  const std::string b1 = b.substr(1);
  std::size_t least =
      std::min({slow_distance(a1, b) + 1, slow_distance(a, b1) + 1, slow_distance(a1, b1) + (a[0] == b[0] ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    least = std::min(least, slow_distance(a.substr(2), b.substr(2)) + 1);
  }
  return least;
}

TEST(EditDistance, AgreesWithItsDefinition) {
  const std::vector<std::string> words = {"", "a", "ab", "ba", "abc", "acb", "voxel", "vxoel", "pixel", "aabb"};
  for (const std::string& a : words) {
    for (const std::string& b : words) {
      EXPECT_EQ(edit_distance(a, b), slow_distance(a, b)) << a << " " << b;
      EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << " " << b;
    }
  }
}

TEST(NearestName, FindsWhatIsAlikeOnly) {
  const std::vector<std::string> names = {"voxel_m", "hypotheses", "seed"};
  EXPECT_EQ(nearest_name("voxle_m", names), "voxel_m");
  EXPECT_EQ(nearest_name("hypothesis", names), "hypotheses");
  EXPECT_EQ(nearest_name("SEED", names), "");
  EXPECT_EQ(nearest_name("zebra", names), "");
  EXPECT_EQ(nearest_name("x", {"ab"}), "") << "nothing in common";
}

TEST(NearestPath, LooksAtTheWholeAndAtTheEnd) {
  const std::vector<std::string> paths = {"odometry.voxel_m", "map.loop_radius_m"};
  EXPECT_EQ(nearest_path("odometri.voxel_m", paths), "odometry.voxel_m");
  EXPECT_EQ(nearest_path("slam.loop_radius", paths), "map.loop_radius_m");
  EXPECT_EQ(nearest_path("slam.colour", paths), "");
}

}  // namespace
}  // namespace loopmark::config

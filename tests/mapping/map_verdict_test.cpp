// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/map_verdict.hpp"

#include <gmock/gmock.h>

namespace loopmark::mapping {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Three scans 10 m apart, each a keyframe, in one component, and one registration that was not kept.
struct SmallMap {
  SmallMap() {
    for (std::size_t i = 0; i < 3; ++i) {
      map_store::ScanRecord scan;
      scan.scan = i;
      scan.stamp_s = 0.1 * static_cast<double>(i);
      scan.keyframe = i;
      scan.T_segment_lidar = pose_from_yaw(0.0, {10.0 * static_cast<double>(i), 0.0, 0.0});
      scans.push_back(scan);
      map.T_map_scan.push_back(scan.T_segment_lidar);
      map.T_map_keyframe.push_back(scan.T_segment_lidar);
      map.component.push_back(0);
      map.solution.component_of.push_back(0);
    }
    map.keyframes = keyframes_of(scans);
    map.components = 1;
    map_store::LoopRecord loop;
    loop.source = 2;
    loop.target = 0;
    loop.answered = true;
    loop.p_correct = 0.999;
    loop.T_target_source = map.T_map_keyframe[2];
    loops.push_back(loop);
    map.loops.resize(1);
  }

  std::vector<map_store::ScanRecord> scans;
  std::vector<map_store::LoopRecord> loops;
  SolvedMap map;
};

TEST(MapVerdict, AMapThatNothingSpeaksAgainstIsGood) {
  const SmallMap small;
  EXPECT_EQ(verdict_text(doubts_of(small.scans, small.loops, small.map)), "good");
}

TEST(MapVerdict, ASureRegistrationElsewhereIsAContradiction) {
  SmallMap small;
  small.loops[0].T_target_source.translation().x() += 4.4;
  const std::vector<MapDoubt> doubts = doubts_of(small.scans, small.loops, small.map);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_THAT(doubts[0].scans, ElementsAre(0U, 2U));
  EXPECT_THAT(verdict_text(doubts), HasSubstr("scans 2 and 0 by 4.4 m"));
  small.loops[0].p_correct = 0.95;  // not sure
  EXPECT_TRUE(doubts_of(small.scans, small.loops, small.map).empty());
}

TEST(MapVerdict, ScansWithoutAPlaceAndScansThatMayHaveSlidAreNamed) {
  SmallMap small;
  small.map.component[2] = 1;
  small.scans[1].problem = "few points fit";
  const std::vector<MapDoubt> doubts = doubts_of(small.scans, small.loops, small.map);
  ASSERT_EQ(doubts.size(), 2U);
  EXPECT_THAT(doubts[0].scans, ElementsAre(2U));
  EXPECT_THAT(doubts[1].scans, ElementsAre(1U));
  EXPECT_THAT(verdict_text(doubts), HasSubstr("doubtful: 1 scans have no place in the map"));
}

TEST(MapVerdict, TimesThatDoNotRiseAreDoubted) {
  SmallMap small;
  small.scans[2].stamp_s = 0.05;
  const std::vector<MapDoubt> doubts = doubts_of(small.scans, small.loops, small.map);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_THAT(doubts[0].scans, ElementsAre(2U));
}

}  // namespace
}  // namespace loopmark::mapping

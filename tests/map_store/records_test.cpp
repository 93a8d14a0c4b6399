// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/records.hpp"

#include <gtest/gtest.h>

#include "loopmark/core/error.hpp"

namespace loopmark::map_store {
namespace {

ScanRecord scan_record() {
  ScanRecord r;
  r.scan = 17;
  r.stamp_s = 1565943701.127806;
  r.state = ScanState::kRecovered;
  r.segment = 2;
  r.keyframe = 0;
  r.T_segment_lidar = pose_from_yaw(0.1, {1.0 / 3.0, -2e-17, 3e5});
  r.velocity << 1, 2, 3, 4, 5, 1.0 / 7.0;
  r.inlier_share = 0.1;
  r.degenerate = 1;
  r.tracking = odometry::Tracking::kDegenerate;
  r.covariance = Matrix6d::Identity() / 3.0;
  r.problem = "few points fit the map, and elsewhere hardly fewer";
  return r;
}

TEST(Records, AScanComesBackToTheBit) {
  const ScanRecord r = scan_record();
  const ScanRecord back = scan_from_line(to_line(r));
  EXPECT_EQ(back.scan, r.scan);
  EXPECT_EQ(back.stamp_s, r.stamp_s);
  EXPECT_EQ(back.state, r.state);
  EXPECT_EQ(back.keyframe, r.keyframe);
  EXPECT_TRUE(back.T_segment_lidar.matrix() == r.T_segment_lidar.matrix());
  EXPECT_TRUE(back.velocity == r.velocity);
  EXPECT_TRUE(back.covariance == r.covariance);
  EXPECT_EQ(back.problem, r.problem);
  EXPECT_EQ(to_line(back), to_line(r));
}

TEST(Records, ALoopComesBackWithItsEvidence) {
  LoopRecord r;
  r.source = 9;
  r.target = 4;
  r.origin = "place";
  r.answered = true;
  r.p_correct = 0.97;
  r.evidence = {{"agreement", 0.5}, {"conflict", 1.0 / 30.0}};
  r.reason = "";
  const LoopRecord back = loop_from_line(to_line(r));
  EXPECT_EQ(back.evidence, r.evidence);
  EXPECT_EQ(to_line(back), to_line(r));
}

TEST(Records, NonsenseIsRefused) {
  EXPECT_THROW(scan_from_line(""), InputError);
  EXPECT_THROW(scan_from_line("1 2 three"), InputError);
  EXPECT_THROW(loop_from_line(to_line(scan_record()).substr(0, 30)), InputError);
}

}  // namespace
}  // namespace loopmark::map_store

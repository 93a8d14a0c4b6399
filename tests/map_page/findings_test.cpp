// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_page/findings.hpp"

#include <gmock/gmock.h>

#include "map_page/sample_runs.hpp"

namespace loopmark::map_page {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_support::SampleRun;
using testing_support::scene_run;

std::vector<std::string> texts(const SampleRun& run) {
  std::vector<std::string> result;
  for (const Finding& finding : findings(run.input().records)) {
    result.push_back(finding.text);
  }
  return result;
}

const Finding* finding_with(const std::vector<Finding>& all, const std::string& words) {
  for (const Finding& finding : all) {
    if (finding.text.find(words) != std::string::npos) {
      return &finding;
    }
  }
  return nullptr;
}

TEST(Findings, ALoopNearTheThresholdIsToBeLookedAt) {
  const SampleRun run = scene_run();
  const std::vector<Finding> all = findings(run.input().records);
  const Finding* near = finding_with(all, "near the threshold");
  ASSERT_NE(near, nullptr);
  ASSERT_EQ(near->links.size(), 1U);
  EXPECT_EQ(near->links[0].text, "24-12");
  EXPECT_EQ(near->links[0].kind, LinkKind::kLoop);
  EXPECT_EQ(near->links[0].first, 1U);
}

TEST(Findings, ASureLoopThatTheGraphRefusedIsAContradiction) {
  SampleRun run = scene_run();
  EXPECT_THAT(texts(run), Not(Contains(HasSubstr("contradict"))));
  run.map.loops[0].accepted = false;
  EXPECT_THAT(texts(run), Contains(HasSubstr("1 loop that registration is sure of contradicts")));
}

TEST(Findings, WhatAPersonDecidedIsSaidAndNotDoubtedAgain) {
  SampleRun run = scene_run();
  run.decisions = {{12, 6, map_store::LoopOverride::kVeto}};
  EXPECT_THAT(texts(run), Contains(HasSubstr("1 loop was decided by a person")));
  EXPECT_THAT(texts(run), Not(Contains(HasSubstr("near the threshold"))));
}

TEST(Findings, LostScansAreNamedWithTheTimeOfTheLongestLoss) {
  SampleRun run = scene_run();
  run.scans[3].tracking = odometry::Tracking::kLost;
  for (std::size_t i = 20; i < 25; ++i) {
    run.scans[i].tracking = odometry::Tracking::kLost;
  }
  const std::vector<Finding> all = findings(run.input().records);
  EXPECT_EQ(all.front().severity, Severity::kProblem);
  EXPECT_EQ(all.front().text, "Tracking was lost for 6 scans, longest at 13:00:02.");
  ASSERT_EQ(all.front().links.size(), 2U);
  EXPECT_EQ(all.front().links[0].first, 20U);
  EXPECT_EQ(all.front().links[0].last, 24U);
}

TEST(Findings, HeightThatNothingHoldsIsTold) {
  SampleRun run = scene_run();
  for (std::size_t i = 10; i < 20; ++i) {
    run.map.covariance[i](2, 2) = 4.0;
  }
  EXPECT_THAT(texts(run), Contains(HasSubstr("Height is not held for 10 scans (1 sigma up to 2.00 m)")));
}

TEST(Findings, PartsWithoutAPlaceAreTheFirstThingSaid) {
  const std::vector<Finding> all = findings(testing_support::parts_run(3).input().records);
  EXPECT_EQ(all.front().severity, Severity::kProblem);
  EXPECT_THAT(all.front().text, HasSubstr("2 parts of the drive (90 scans) found no place"));
}

TEST(Findings, WithoutLoopsTheDriftIsTold) {
  SampleRun run = scene_run();
  run.loops.clear();
  run.map.loops.clear();
  EXPECT_THAT(texts(run), Contains(HasSubstr("No loop was accepted")));
}

// An uncertain rotation about the map's origin moves a place 100 m away by 100 m times the angle.
TEST(PositionSigma, GrowsWithTheLeverOfAnUncertainRotation) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(5, 5) = 0.01 * 0.01;  // yaw, radians
  const Eigen::Vector3d sigma = position_sigma(pose_from_yaw(0.4, {100.0, 0.0, 5.0}), covariance);
  EXPECT_NEAR(sigma.x(), 0.0, 1e-9);
  EXPECT_NEAR(sigma.y(), 1.0, 1e-9);
  EXPECT_NEAR(sigma.z(), 0.0, 1e-9);
}

}  // namespace
}  // namespace loopmark::map_page

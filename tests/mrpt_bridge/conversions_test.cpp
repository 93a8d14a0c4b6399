// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mrpt_bridge/conversions.hpp"

#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "io/io_fixtures.hpp"
#include "loopmark/core/pose.hpp"

namespace loopmark::mrpt_bridge {
namespace {

using testing::random_cloud;

Pose some_pose() {
  Vector6d xi;
  xi << 3, -4, 1, 0.2, -0.5, 1.4;
  return exp_se3(xi);
}

Vector6d mrpt_coordinates(const Pose& pose) {
  const mrpt::poses::CPose3D p = to_mrpt(pose);
  Vector6d v;
  v << p.x(), p.y(), p.z(), p.yaw(), p.pitch(), p.roll();
  return v;
}

TEST(Conversions, PosesComeBack) {
  EXPECT_LT((from_mrpt(to_mrpt(some_pose())).matrix() - some_pose().matrix()).norm(), 1e-12);
  EXPECT_NEAR(to_mrpt(pose_from_yaw(0.3, {1, 2, 3})).yaw(), 0.3, 1e-12);
}

TEST(Conversions, CovarianceFollowsFiniteDifferences) {
  const Pose pose = some_pose();
  Matrix6d jacobian;
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = kStep * Vector6d::Unit(k);
    jacobian.col(k) = (mrpt_coordinates(exp_se3(step) * pose) - mrpt_coordinates(exp_se3(-step) * pose)) / (2 * kStep);
  }
  Matrix6d root = Matrix6d::Random();
  const Matrix6d covariance = root * root.transpose() + Matrix6d::Identity();
  const auto pdf = to_mrpt(pose, covariance);
  const Matrix6d expected = jacobian * covariance * jacobian.transpose();
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) {
      EXPECT_NEAR(pdf.cov(r, c), expected(r, c), 1e-5 * expected.norm());
    }
  }
  EXPECT_LT((covariance_from_mrpt(pdf) - covariance).norm(), 1e-9 * covariance.norm());
}

TEST(Conversions, CloudsKeepTimesAndRingsInAVelodyneScan) {
  const Scan scan{0, 1600000000.25, random_cloud(200)};
  const auto cloud = cloud_from_observation(*observation_from_scan(scan, "top"));
  ASSERT_TRUE(cloud.has_value());
  EXPECT_EQ(cloud->points, scan.cloud.points);
  EXPECT_EQ(cloud->intensity, scan.cloud.intensity);
  EXPECT_EQ(cloud->ring, scan.cloud.ring);
  ASSERT_EQ(cloud->time_offset_s.size(), 200U);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_NEAR(cloud->time_offset_s[i], scan.cloud.time_offset_s[i], 2e-7);  // MRPT's clock ticks every 100 ns
  }
}

TEST(Conversions, CloudsWithoutTimesBecomePointClouds) {
  Scan scan{0, 12.5, random_cloud(100)};
  scan.cloud.time_offset_s.clear();
  scan.cloud.ring.clear();
  const auto observation = observation_from_scan(scan, "top");
  EXPECT_NE(dynamic_cast<mrpt::obs::CObservationPointCloud*>(observation.get()), nullptr);
  const auto cloud = cloud_from_observation(*observation);
  ASSERT_TRUE(cloud.has_value());
  EXPECT_EQ(cloud->points, scan.cloud.points);
  EXPECT_EQ(cloud->intensity, scan.cloud.intensity);
}

TEST(Conversions, SensoryFramesGiveTheScanOfTheLabel) {
  mrpt::obs::CSensoryFrame frame;
  frame.insert(mrpt::obs::CObservationOdometry::Create());
  frame.insert(observation_from_scan({0, 1.0, random_cloud(60)}, "front"));
  frame.insert(observation_from_scan({0, 1.0, random_cloud(70)}, "rear"));
  EXPECT_EQ(scan_from_sensory_frame(frame)->cloud.size(), 60U);
  EXPECT_EQ(scan_from_sensory_frame(frame, "rear")->cloud.size(), 70U);
  EXPECT_FALSE(scan_from_sensory_frame(frame, "left").has_value());
}

}  // namespace
}  // namespace loopmark::mrpt_bridge

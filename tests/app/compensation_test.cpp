// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/compensation_of_log.hpp"

#include <gtest/gtest.h>

#include "support/shared_data.hpp"

namespace loopmark::app {
namespace {

TEST(CompensationOfLog, RawSweepsOfARealDriveAreFoundWithTheirDirection) {
  const auto folder = testing_support::unpacked_log("kitti_raw_city");
  if (!folder) {
    GTEST_SKIP() << "no shared logs";
  }
  const odometry::CompensationMeasurement measurement = workflows::compensation_of_log(*io::open_log(*folder));
  EXPECT_EQ(measurement.verdict, odometry::Compensation::kRawClockwise) << workflows::describe_measurement(measurement);
}

TEST(CompensationOfLog, KeyframesTellNothing) {
  const auto folder = testing_support::unpacked_log("mulran_kaist03");
  if (!folder) {
    GTEST_SKIP() << "no shared logs";
  }
  EXPECT_EQ(workflows::compensation_of_log(*io::open_log(*folder)).verdict, odometry::Compensation::kUnknown);
}

}  // namespace
}  // namespace loopmark::app

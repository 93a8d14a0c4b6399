// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/messages/wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "loopmark/messages/definitions.hpp"
#include "loopmark/messages/types.hpp"

namespace loopmark::messages {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) {
    bytes.push_back(static_cast<char>(value));
  }
  return bytes;
}

/// Bytes worked out by hand from the specification (alignment counts from behind the four bytes of the head).
TEST(Wire, CdrIsAlignedAndStringsEndWithZero) {
  Header header;
  header.seconds = 1;
  header.nanoseconds = 2;
  header.frame_id = "ab";
  EXPECT_EQ(encode(Encoding::kCdr, header), bytes_of({0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 'a', 'b', 0}));
  PointField field{"x", 4, 7, 1};
  EXPECT_EQ(encode(Encoding::kCdr, field),
            bytes_of({0, 1, 0, 0, 2, 0, 0, 0, 'x', 0, 0, 0, 4, 0, 0, 0, 7, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(Wire, Ros1IsPackedAndItsHeaderHasASequenceNumber) {
  Header header{7, 1, 2, "ab"};
  EXPECT_EQ(encode(Encoding::kRos1, header), bytes_of({7, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 'a', 'b'}));
  EXPECT_EQ(encode(Encoding::kRos1, PointField{"x", 4, 7, 1}), bytes_of({1, 0, 0, 0, 'x', 4, 0, 0, 0, 7, 1, 0, 0, 0}));
}

class Encodings : public ::testing::TestWithParam<Encoding> {};
INSTANTIATE_TEST_SUITE_P(Wire, Encodings, ::testing::Values(Encoding::kCdr, Encoding::kRos1));

TEST_P(Encodings, MessagesComeBack) {
  Imu imu;
  imu.header.frame_id = "imu_link";
  imu.header.set_stamp_ns(4'000'000'000'123'456'789);  // in 2096
  imu.angular_velocity = {0.1, -0.2, 0.3};
  imu.linear_acceleration_covariance[8] = 5.0;
  const Imu back = decode<Imu>(GetParam(), encode(GetParam(), imu));
  EXPECT_EQ(back.header.stamp_ns(), 4'000'000'000'123'456'789);
  EXPECT_EQ(back.header.frame_id, "imu_link");
  EXPECT_EQ(back.angular_velocity, imu.angular_velocity);
  EXPECT_EQ(back.linear_acceleration_covariance, imu.linear_acceleration_covariance);

  NavSatFix fix;
  fix.header.frame_id = "x";
  fix.status = -1;
  fix.latitude_deg = 48.1;
  fix.covariance_type = 2;
  const NavSatFix fix_back = decode<NavSatFix>(GetParam(), encode(GetParam(), fix));
  EXPECT_EQ(fix_back.status, -1);
  EXPECT_EQ(fix_back.latitude_deg, 48.1);
  EXPECT_EQ(fix_back.covariance_type, 2);

  LivoxScan scan;
  scan.points.resize(3);
  scan.points[2] = {7, 1.0F, 2.0F, 3.0F, 9, 8, 5};
  const LivoxScan scan_back = decode<LivoxScan>(GetParam(), encode(GetParam(), scan));
  ASSERT_EQ(scan_back.points.size(), 3U);
  EXPECT_EQ(scan_back.points[2].offset_ns, 7U);
  EXPECT_EQ(scan_back.points[2].line, 5);
}

/// Every length that is too short, and counts that the bytes cannot hold, are errors.
TEST_P(Encodings, CutOffAnywhereIsAnError) {
  TransformMessage message;
  message.transforms.resize(2);
  message.transforms[1].child_frame_id = "lidar";
  const std::string bytes = encode(GetParam(), message);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(decode<TransformMessage>(GetParam(), bytes.substr(0, size)), InputError) << size;
  }
  std::string many = bytes;
  many[GetParam() == Encoding::kCdr ? 7 : 3] = '\x7f';
  EXPECT_THROW(decode<TransformMessage>(GetParam(), many), InputError);
}

TEST(Wire, OtherRepresentationsAreRefusedByName) {
  std::string bytes = encode(Encoding::kCdr, Header{});
  const auto refusal = [&](int low) -> std::string {
    bytes[1] = static_cast<char>(low);
    try {
      decode<Header>(Encoding::kCdr, bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(0), HasSubstr("big-endian CDR"));
  EXPECT_THAT(refusal(3), HasSubstr("parameter list"));
  EXPECT_THAT(refusal(7), HasSubstr("XCDR version 2"));
  EXPECT_THAT(refusal(77), HasSubstr("unknown representation"));
  EXPECT_THAT(refusal(1), IsEmpty());
}

TEST(Definitions, OtherFieldsAreFound) {
  recordings::Channel channel{"/imu", "sensor_msgs/Imu", Encoding::kCdr, "cdr", "", ""};
  EXPECT_THAT(definition_problem(channel), IsEmpty());
  for (const bool ros1 : {true, false}) {
    channel.definition = definition_text("sensor_msgs/Imu", ros1);
    EXPECT_THAT(definition_problem(channel), IsEmpty());
  }
  channel.definition =
      "# a comment\nHeader header\nuint8 A=3\nQuaternion orientation # why\n"
      "float64[9] orientation_covariance\nVector3 angular_velocity\n"
      "float64[9] angular_velocity_covariance\nVector3 linear_acceleration\n"
      "float64[9] linear_acceleration_covariance\n";
  EXPECT_THAT(definition_problem(channel), IsEmpty());
  channel.definition = "std_msgs/Header header\nfloat64 x\n";
  EXPECT_THAT(definition_problem(channel), HasSubstr("sensor_msgs/Imu"));
  channel.definition = definition_text("sensor_msgs/Imu", false);
  channel.definition.replace(channel.definition.rfind("float64 z"), 9, "float32 z");
  EXPECT_THAT(definition_problem(channel), HasSubstr("otherwise"));
}

}  // namespace
}  // namespace loopmark::messages

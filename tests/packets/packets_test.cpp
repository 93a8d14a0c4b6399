// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "loopmark/core/error.hpp"
#include "loopmark/packets/packet_decoder.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace loopmark::packets {
namespace {

using ::testing::HasSubstr;
using testing_support::TemporaryFolder;

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

/// A VLP-16 packet: the sensor turns 0.4 degrees from block to block, every laser sees something 10 m away.
std::string vlp16_packet(double first_deg, std::uint8_t mode = 0x37) {
  std::string bytes(1206, '\0');
  for (std::size_t block = 0; block < 12; ++block) {
    put(bytes, block * 100, std::uint16_t{0xEEFF});
    const double turned = mode == 0x39 ? static_cast<double>(block / 2) : static_cast<double>(block);
    put(bytes, block * 100 + 2, static_cast<std::uint16_t>(std::fmod(first_deg + 0.4 * turned, 360.0) * 100.0 + 0.5));
    for (std::size_t i = 0; i < 32; ++i) {
      put(bytes, block * 100 + 4 + 3 * i, std::uint16_t{5000});
      bytes[block * 100 + 6 + 3 * i] = 77;
    }
  }
  put(bytes, 1200, std::uint32_t{1'000'000});
  bytes[1204] = static_cast<char>(mode);
  bytes[1205] = 0x22;
  return bytes;
}

TEST(Velodyne, PointsLieOnTheirBeams) {
  const std::string bytes = vlp16_packet(0.0);
  const auto decoder = make_decoder(bytes, {});
  ASSERT_NE(decoder, nullptr);
  EXPECT_EQ(decoder->sensor(), "Velodyne VLP-16");
  SweepCloud sweep;
  decoder->decode({5, bytes}, 0, 12, sweep);
  ASSERT_EQ(sweep.cloud.size(), 384U);
  EXPECT_EQ(sweep.start_ns, 5);
  const double pi = std::acos(-1.0);
  const Eigen::Vector3f first(static_cast<float>(10.0 * std::cos(15.0 * pi / 180.0)), 0.0F,
                              static_cast<float>(-10.0 * std::sin(15.0 * pi / 180.0)));
  EXPECT_NEAR((sweep.cloud.points[0] - first).norm(), 0.0, 1e-5);  // laser 0: 15 degrees down, straight ahead
  EXPECT_EQ(sweep.cloud.ring[0], 0);
  EXPECT_EQ(sweep.cloud.ring[1], 8);            // the second laser fired looks 1 degree up
  EXPECT_LT(sweep.cloud.points[16].y(), 0.0F);  // turning clockwise, to the right
  EXPECT_NEAR(sweep.cloud.time_offset_s[1], 2.304e-6, 1e-9);
  EXPECT_NEAR(sweep.cloud.time_offset_s[16], 55.296e-6, 1e-9);
  EXPECT_NEAR(sweep.cloud.time_offset_s[32], 2 * 55.296e-6, 1e-9);
  for (const Eigen::Vector3f& p : sweep.cloud.points) {
    EXPECT_NEAR(p.norm(), 10.0, 1e-4);
  }
}

TEST(Velodyne, AnEchoThatIsSentTwiceIsOnePoint) {
  std::string bytes = vlp16_packet(10.0, 0x39);
  put(bytes, 100 + 4, std::uint16_t{6000});  // but this one: a second echo 2 m behind
  const auto decoder = make_decoder(bytes, {});
  SweepCloud sweep;
  decoder->decode({0, bytes}, 0, 12, sweep);
  EXPECT_EQ(sweep.cloud.size(), 192U + 1U);
}

TEST(Velodyne, ATurnEndsWhereTheAnglePassesZero) {
  const auto decoder = make_decoder(vlp16_packet(0.0), {});
  CutState state;
  EXPECT_FALSE(decoder->cut(vlp16_packet(350.0), state));
  const auto cut = decoder->cut(vlp16_packet(358.0), state);  // 358.0, 358.4, ..., 359.6, 0.0
  ASSERT_TRUE(cut);
  EXPECT_EQ(*cut, 5U);
  EXPECT_FALSE(decoder->cut(vlp16_packet(2.8), state));
}

TEST(Velodyne, ModelsWithoutNominalAnglesNeedTheirFile) {
  std::string bytes = vlp16_packet(0.0);
  bytes[1205] = static_cast<char>(0xA1);
  try {
    make_decoder(bytes, {});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("calibration.yaml"));
  }
}

TEST(Packets, OthersAreNotTakenForASensors) {
  EXPECT_EQ(make_decoder("", {}), nullptr);
  EXPECT_EQ(make_decoder(std::string(1206, 'x'), {}), nullptr);
  for (std::size_t size = 0; size < 1300; ++size) {
    EXPECT_EQ(make_decoder(std::string("\xee\xff\x40\x06", 4) + std::string(size % 1100, '\1'), {}), nullptr) << size;
  }
  EXPECT_FALSE(read_ouster_imu("abc"));
}

std::string ouster_json() {
  return R"({"prod_line": "OS-1-4", "lidar_mode": "512x10",
  "data_format": {"columns_per_frame": 512, "columns_per_packet": 2, "pixels_per_column": 4,
                  "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16"},
  "beam_altitude_angles": [15.0, 5.0, -5.0, -15.0], "beam_azimuth_angles": [0, 0, 0, 0],
  "lidar_origin_to_beam_origin_mm": 0,
  "lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.0, 0, 0, 0, 1]})";
}

/// A packet of two columns of four pixels, 4 m away; column `first` of the frame and the next.
std::string ouster_packet(std::uint16_t frame, std::uint16_t first) {
  constexpr std::size_t kColumn = 12 + 4 * 12;
  std::string bytes(32 + 2 * kColumn + 32, '\0');
  put(bytes, 2, frame);
  for (std::size_t c = 0; c < 2; ++c) {
    const std::size_t at = 32 + c * kColumn;
    put(bytes, at, std::uint64_t{1'000'000'000} + 200'000 * c);
    put(bytes, at + 8, static_cast<std::uint16_t>(first + c));
    put(bytes, at + 10, std::uint16_t{1});
    for (std::size_t r = 0; r < 4; ++r) {
      put(bytes, at + 12 + r * 12, std::uint32_t{4000});
    }
  }
  return bytes;
}

TEST(Ouster, PointsLieOnTheirBeams) {
  const TemporaryFolder folder;
  std::ofstream(folder / "os.json") << ouster_json();
  const auto decoder = make_ouster_decoder(folder / "os.json");
  const std::string bytes = ouster_packet(7, 0);
  ASSERT_TRUE(decoder->accepts(bytes));
  SweepCloud sweep;
  decoder->decode({0, bytes}, 0, 2, sweep);
  ASSERT_EQ(sweep.cloud.size(), 8U);
  const float along = 4.0F * std::cos(15.0F * static_cast<float>(M_PI) / 180.0F);
  EXPECT_NEAR(sweep.cloud.points[0].x(), -along, 1e-5);  // column 0 looks backwards from the sensor's front
  EXPECT_NEAR(sweep.cloud.points[0].z(), 0.036F + 4.0F * std::sin(15.0F * static_cast<float>(M_PI) / 180.0F), 1e-5);
  EXPECT_EQ(sweep.cloud.ring[0], 3);
  EXPECT_NEAR(sweep.cloud.time_offset_s[4], 2e-4, 1e-9);
  CutState state;
  EXPECT_FALSE(decoder->cut(ouster_packet(7, 0), state));
  EXPECT_FALSE(decoder->cut(ouster_packet(7, 2), state));
  EXPECT_TRUE(decoder->cut(ouster_packet(8, 0), state));
  EXPECT_FALSE(decoder->cut(ouster_packet(7, 4), state));  // late
  EXPECT_FALSE(decoder->cut(ouster_packet(8, 2), state));
}

TEST(Ouster, MetadataThatLacksSomethingIsAnError) {
  const TemporaryFolder folder;
  const auto problem_of = [&](const std::string& from, const std::string& to) -> std::string {
    std::string text = ouster_json();
    text.replace(text.find(from), from.size(), to);
    std::ofstream(folder / "os.json") << text;
    try {
      make_ouster_decoder(folder / "os.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem_of("OS-1-4", "OS-1-4"), "");
  EXPECT_THAT(problem_of("\"columns_per_frame\": 512, ", ""), HasSubstr("columns_per_frame"));
  EXPECT_THAT(problem_of("\"pixels_per_column\": 4", "\"pixels_per_column\": 5"), HasSubstr("4 beams but 5"));
  EXPECT_THAT(problem_of("[15.0, 5.0, -5.0, -15.0]", "[0, 0, 0, 0]"), HasSubstr("all beam_altitude_angles are 0"));
  EXPECT_THAT(problem_of("512x10", "1024x10"), HasSubstr("lidar_mode is 1024x10"));
  EXPECT_THAT(problem_of("RNG19_RFL8_SIG16_NIR16", "RNG99"), HasSubstr("RNG99"));
  EXPECT_THAT(problem_of("{", "["), HasSubstr("is no JSON"));
}

TEST(Ouster, RealMalformedMetadataIsRefused) {
  const auto folder = testing_support::shared_path("logs/packets/ouster_malformed_metadata");
  if (!folder) GTEST_SKIP() << "no shared logs";
  for (const char* name : {"complete_but_all_zeros_legacy", "garbled_legacy_and_nonlegacy",
                           "incomplete_data_format_legacy", "incomplete_data_format_nonlegacy",
                           "incomplete_no_sensor_info_nonlegacy", "incorrect_nbeam_angles_legacy_113"}) {
    EXPECT_THROW(make_ouster_decoder(*folder / (std::string(name) + ".json")), InputError) << name;
  }
}

}  // namespace
}  // namespace loopmark::packets

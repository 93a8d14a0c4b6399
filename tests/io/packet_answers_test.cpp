// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Packets of real sensors against what another program decoded them to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/point_files.hpp"
#include "support/shared_data.hpp"

namespace loopmark::io {
namespace {

/// The share of every 97th point of `a` that has a point of `b` within 0.02 m.
double share_met(const PointCloud& a, const PointCloud& b) {
  std::size_t met = 0;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < a.size(); i += 97) {
    float nearest = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& p : b.points) {
      nearest = std::min(nearest, (p - a.points[i]).squaredNorm());
    }
    met += nearest <= 0.02F * 0.02F ? 1 : 0;
    ++asked;
  }
  return static_cast<double>(met) / static_cast<double>(std::max<std::size_t>(asked, 1));
}

struct Answer {
  const char* log;
  const char* points;
  std::size_t scan;  ///< the one of the log that was decoded
  double least_met;
};

class PacketAnswers : public ::testing::TestWithParam<Answer> {};
INSTANTIATE_TEST_SUITE_P(
    RealSensors, PacketAnswers,
    ::testing::Values(Answer{"hesai_xt32/1673400677802009732", "hesai_xt32/1673400678101968885.pcd", 3, 0.99},
                      Answer{"hesai_pandar64/1673403880599376836", "hesai_pandar64/1673403880898440686.pcd", 2, 0.99},
                      Answer{"hesai_qt64/1673401195788312575", "hesai_qt64/1673401196087570870.pcd", 2, 0.99},
                      // The other program does not turn the last pair of blocks of a packet with two returns on; a
                      // sixth of the points.
                      Answer{"velodyne_vlp16/1673400471837873222", "velodyne_vlp16/1673400472138016708.pcd", 3, 0.96}));

TEST_P(PacketAnswers, ThePointsAreTheSame) {
  const auto folder = testing_support::shared_path("logs/packets");
  if (!folder) GTEST_SKIP() << "no shared logs";
  const PointCloud cloud = open_log(*folder / GetParam().log)->read(GetParam().scan).cloud;
  const PointCloud answer = read_point_file(*folder / GetParam().points).cloud;
  const auto count = static_cast<double>(answer.size());
  EXPECT_NEAR(static_cast<double>(cloud.size()), count, 0.005 * count);
  EXPECT_GE(share_met(cloud, answer), GetParam().least_met);
  EXPECT_GE(share_met(answer, cloud), GetParam().least_met);
  EXPECT_EQ(cloud.time_offset_s.size(), cloud.size());
}

TEST(PacketCaptures, OustersAreDecodedAndNeedTheirMetadata) {
  const auto folder = testing_support::shared_path("logs/packets");
  if (!folder) GTEST_SKIP() << "no shared logs";
  EXPECT_EQ(open_log(*folder / "ouster_os0_128/os0_128.pcap")->read(0).cloud.size(), 97299U);
  EXPECT_EQ(open_log(*folder / "ouster_os2_32/os2_32.pcap")->read(0).cloud.size(), 28541U);
  EXPECT_THROW(open_log(*folder / "ouster_os1_64_fw20/os1_64.pcap"), InputError);
}

}  // namespace
}  // namespace loopmark::io

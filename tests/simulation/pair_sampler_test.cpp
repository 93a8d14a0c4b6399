// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/pair_sampler.hpp"

#include <gtest/gtest.h>

#include <array>

#include "loopmark/cloud/overlap.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/simulation/sweep.hpp"
#include "small_town.hpp"

namespace loopmark::simulation {
namespace {

PairOptions few_pairs() {
  PairOptions o;
  o.pairs = 7;
  o.negatives = 3;
  o.sensor = "hdl32e";
  return o;
}

TEST(PairSampler, SpreadsTheOverlapAndTellsTheTruth) {
  std::vector<PointCloud> scans;
  const PairSample sample = sample_pairs(small_town(), few_pairs(), [&](std::size_t index, const PointCloud& cloud) {
    EXPECT_EQ(index, scans.size());
    scans.push_back(cloud);
  });
  ASSERT_EQ(sample.pairs.size(), 7U);
  ASSERT_EQ(sample.negatives.size(), 3U);
  ASSERT_EQ(sample.T_town_lidar.size(), scans.size());
  std::array<int, 7> bins{};
  for (const SampledPair& pair : sample.pairs) {
    const Pose truth = sample.T_town_lidar[pair.target].inverse() * sample.T_town_lidar[pair.source];
    EXPECT_LT(pose_error(pair.T_target_source, truth).translation_m, 1e-9);
    EXPECT_LE(pair.T_target_source.translation().norm(), 100.0);
    const cloud::Overlap shared = cloud::overlap(scans[pair.source], scans[pair.target], pair.T_target_source);
    EXPECT_DOUBLE_EQ(shared.symmetric, pair.overlap_symmetric);
    ++bins.at(static_cast<std::size_t>((pair.overlap_symmetric - 0.2) / 0.1));
  }
  for (const int count : bins) {
    EXPECT_EQ(count, 1);
  }
  for (const auto& [a, b] : sample.negatives) {
    const Pose truth = sample.T_town_lidar[b].inverse() * sample.T_town_lidar[a];
    EXPECT_LE(cloud::overlap(scans[a], scans[b], truth).symmetric, 0.005);
  }
}

TEST(PairSampler, IsTheSameForASeed) {
  PairOptions o = few_pairs();
  o.pairs = 2;
  o.negatives = 1;
  const auto nothing = [](std::size_t, const PointCloud&) {};
  const PairSample one = sample_pairs(small_town(), o, nothing);
  const PairSample two = sample_pairs(small_town(), o, nothing);
  ASSERT_EQ(one.T_town_lidar.size(), two.T_town_lidar.size());
  for (std::size_t i = 0; i < one.T_town_lidar.size(); ++i) {
    EXPECT_EQ(one.T_town_lidar[i].matrix(), two.T_town_lidar[i].matrix());
  }
}

TEST(PairSampler, BinsOutOfReachGiveTheirShareToOthers) {
  PairOptions o = few_pairs();
  o.negatives = 0;
  o.sensor = "vlp16";
  o.max_overlap = 0.98;
  o.min_overlap = 0.7;
  o.days = 1;
  const PairSample sample = sample_pairs(small_town(), o, [](std::size_t, const PointCloud&) {});
  EXPECT_EQ(sample.pairs.size(), o.pairs);
}

TEST(PairSampler, BlocksOfTheTwoRowsLookAlike) {
  // A place in the first row, and the same place of the last row turned by half a turn: seen as if they were one.
  const auto& nodes = small_town().roads.nodes;
  const Eigen::Vector2d first = nodes.front().position;
  const Eigen::Vector2d last = nodes[24].position;  // 5 x 5 junctions
  const SensorModel sensor = sensor_model("hdl32e");
  const Eigen::Vector2d here = first + Eigen::Vector2d(100.0, -1.75);
  const Eigen::Vector2d there = last - Eigen::Vector2d(100.0, -1.75);
  const double half_turn = 3.14159265358979;
  const PointCloud a = render_standing(small_world(), nullptr, sensor,
                                       standing_pose(small_town().terrain, here, 0.0, sensor.height_m), 1);
  const PointCloud b = render_standing(small_world(), nullptr, sensor,
                                       standing_pose(small_town().terrain, there, half_turn, sensor.height_m), 2);
  EXPECT_GT(cloud::overlap(a, b, Pose::Identity()).symmetric, 0.6);
}

TEST(PairSampler, SenselessOptionsAreRefused) {
  PairOptions o = few_pairs();
  o.min_overlap = 0.9;
  EXPECT_THROW(sample_pairs(small_town(), o, [](std::size_t, const PointCloud&) {}), InputError);
  o = few_pairs();
  o.sensor_b = "radar";
  EXPECT_THROW(sample_pairs(small_town(), o, [](std::size_t, const PointCloud&) {}), InputError);
}

}  // namespace
}  // namespace loopmark::simulation

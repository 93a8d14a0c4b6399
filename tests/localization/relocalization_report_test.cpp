// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/relocalization_report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "loopmark/io/trajectory.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::localization {
namespace {

using State = RelocalizationState;

RelocalizedScan scan(std::size_t index, State state, bool answered, double x = 0.0) {
  RelocalizedScan s;
  s.scan = index;
  s.stamp_s = 10.0 + 0.1 * static_cast<double>(index);
  s.state = state;
  s.given_up = state == State::kLost;
  s.answered = answered;
  s.T_map_lidar = pose_from_yaw(0.0, {x, 0, 0});
  s.reason = answered ? "" : "nothing, really";
  return s;
}

const std::vector<RelocalizedScan> kScans = {
    scan(0, State::kSearching, false), scan(1, State::kSearching, true, 1.0), scan(2, State::kTracking, true, 2.0),
    scan(3, State::kLost, false),      scan(4, State::kSearching, false),     scan(5, State::kTracking, true, 7.0)};

TEST(RelocalizationSummary, CountsAnswersLossesAndRecoveries) {
  const RelocalizationSummary s = summarize(kScans);
  EXPECT_EQ(s.scans, 6U);
  EXPECT_EQ(s.answered, 3U);
  EXPECT_NEAR(s.first_answer_s, 0.1, 1e-9);
  EXPECT_EQ(s.losses, 1U);
  EXPECT_EQ(s.recoveries, 1U);
  EXPECT_EQ(summarize({}).first_answer_s, -1.0);
}

TEST(RelocalizationSummary, JudgesThroughTheNearestScanOfTheMap) {
  // The world is the map turned and shifted, and the map drifts by 10 m between its two scans.
  const Pose T_world_map = pose_from_yaw(1.0, {100, 50, 0});
  const std::vector<Pose> map = {pose_from_yaw(0, {0, 0, 0}), pose_from_yaw(0, {15, 0, 0})};
  const std::vector<Pose> true_map = {T_world_map, T_world_map * pose_from_yaw(0, {5, 0, 0})};
  std::vector<Pose> query;
  for (const double x : {0.0, 1.1, 2.2, 0.0, 0.0, -3.0}) {
    query.push_back(T_world_map * pose_from_yaw(0, {x, 0, 0}));
  }
  RelocalizationSummary s = summarize(kScans);
  judge(kScans, mapping::MapTruth(map, true_map), query, s);
  EXPECT_EQ(s.judged, 3U);
  EXPECT_EQ(s.wrong, 1U);
  EXPECT_NEAR(s.median_error_m, 0.2, 1e-9);
}

TEST(WriteRelocalization, WritesARowAScanAndTheAnswers) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("loopmark_relocalization_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  write_relocalization(folder, kScans, summarize(kScans));
  const std::string csv = storage::read_file(folder / "relocalization.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_NE(csv.find("3,10.3,lost,1,0,0,,,"), std::string::npos);
  EXPECT_NE(csv.find("nothing; really"), std::string::npos);
  const io::Trajectory trajectory = io::read_trajectory(folder / "trajectory.tum");
  ASSERT_EQ(trajectory.poses.size(), 3U);
  EXPECT_NEAR(trajectory.poses[2].translation().x(), 7.0, 1e-6);
  EXPECT_NE(storage::read_file(folder / "summary.json").find("\"recoveries\": 1"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace loopmark::localization

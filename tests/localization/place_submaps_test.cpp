// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "../../libs/localization/src/place_submaps.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::localization {
namespace {

constexpr double kRadius = 12.0;
constexpr double kStandOff = 25.0;

/// A street of keyframes 4 m apart along x, and far away one of a part that the map does not hang together with.
mapping::SolvedMap street() {
  mapping::SolvedMap solved;
  for (std::size_t i = 0; i < 40; ++i) {
    mapping::Keyframe keyframe;
    keyframe.number = i;
    solved.keyframes.push_back(keyframe);
    solved.T_map_keyframe.push_back(pose_from_yaw(0.1, {4.0 * static_cast<double>(i), 0.5 * std::sin(i), 0.0}));
    solved.solution.component_of.push_back(i == 39 ? 1 : 0);
  }
  solved.T_map_keyframe.back().translation() = Eigen::Vector3d(500.0, 0.0, 0.0);
  return solved;
}

internal::PlaceSubmaps submaps_of(const mapping::SolvedMap& solved, const std::set<std::size_t>& left_out = {}) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("loopmark_submaps_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder.string() + ".partial");
  const map_store::RunFolder run = map_store::RunFolder::create(folder);
  std::filesystem::remove_all(run.path());  // what is asked here needs no files
  return {run, solved, left_out, kRadius, {}};
}

TEST(PlaceSubmaps, HoldTheMainPartWithoutWhatIsLeftOut) {
  const internal::PlaceSubmaps submaps = submaps_of(street(), {3, 7});
  ASSERT_EQ(submaps.size(), 37U);
  EXPECT_EQ(submaps.number(2), 2U);
  EXPECT_EQ(submaps.number(3), 4U);
  EXPECT_EQ(submaps.number(6), 8U);
  EXPECT_NEAR(submaps.T_map_keyframe(3).translation().x(), 16.0, 1e-12);
}

TEST(PlaceSubmaps, AreJudgedByTheNearestAndByOneThatStandsOff) {
  const internal::PlaceSubmaps submaps = submaps_of(street());
  for (const double x : {-10.0, 3.0, 50.0, 77.7, 150.0}) {
    const Eigen::Vector3d position(x, 1.0, 0.0);
    const std::vector<std::size_t> judges = submaps.judges_of(position);
    ASSERT_EQ(judges.size(), 2U) << x;
    const std::size_t nearest = *submaps.nearest_center(position);
    EXPECT_EQ(judges[0], nearest) << x;
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < submaps.size(); ++k) {
      least = std::min(least, std::abs(submaps.distance(submaps.center_of(k), position) - kStandOff));
    }
    EXPECT_DOUBLE_EQ(std::abs(submaps.distance(judges[1], position) - kStandOff), least) << x;
  }
}

TEST(PlaceSubmaps, HaveNoJudgeFarFromTheMap) {
  const internal::PlaceSubmaps submaps = submaps_of(street());
  EXPECT_TRUE(submaps.judges_of({60.0, 2.0 * kRadius + 1.0, 0.0}).empty());
  EXPECT_FALSE(submaps.judges_of({60.0, 2.0 * kRadius - 1.0, 0.0}).empty());
  EXPECT_TRUE(submaps.judges_of({500.0, 0.0, 0.0}).empty()) << "another part";
}

TEST(PlaceSubmaps, SayWhichFileIsMissing) { EXPECT_THROW(submaps_of(street()).prepared(0), InputError); }

TEST(KeyframePlace, OfAnEarlierVersionIsComputedAnew) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("loopmark_place_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder.string() + ".partial");
  const map_store::RunFolder run = map_store::RunFolder::create(folder);
  std::filesystem::create_directories(run.keyframe(4, "place").parent_path());
  PointCloud cloud;
  Rng rng(2);
  for (int i = 0; i < 4000; ++i) {
    const auto along = static_cast<float>(rng.uniform(-40.0, 40.0));
    cloud.points.emplace_back(along, static_cast<float>(rng.uniform(-30.0, 30.0)), -1.7F);
    cloud.points.emplace_back(along, i % 3 == 0 ? 8.0F : -6.0F, static_cast<float>(rng.uniform(-1.7, 3.0)));
  }
  map_store::write_keyframe_cloud(run, 4, cloud);
  map_store::write_keyframe_place(run, 4, cloud);
  const places::PlaceDescriptor written = map_store::read_keyframe_place(run, 4);
  storage::write_file_atomically(run.keyframe(4, "place"), "LPS1 and what followed");
  EXPECT_LT(distance(map_store::read_keyframe_place(run, 4), written), 1e-3);
  storage::write_file_atomically(run.keyframe(4, "place"), "LPS2 and damage");
  EXPECT_THROW(map_store::read_keyframe_place(run, 4), InputError);
  std::filesystem::remove_all(run.path());
}

}  // namespace
}  // namespace loopmark::localization

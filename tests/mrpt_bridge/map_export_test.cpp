// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mrpt_bridge/map_export.hpp"

#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>

#include "io/io_fixtures.hpp"
#include "loopmark/core/error.hpp"

namespace loopmark::mrpt_bridge {
namespace {

namespace fs = std::filesystem;
using testing::random_cloud;
using testing::TemporaryFolder;

SimpleMapKeyframe keyframe(std::size_t i) {
  const Pose pose = pose_from_yaw(0.2 * static_cast<double>(i), {static_cast<double>(i), 1, 2});
  return {pose,
          0.01 * static_cast<double>(i + 1) * Matrix6d::Identity(),
          {i, 50.0 + static_cast<double>(i), random_cloud(60 + i, i)}};
}

TEST(MapExport, SimpleMapIsReadByMrptAndByUs) {
  const TemporaryFolder folder;
  write_simplemap(folder / "map.simplemap", 4, keyframe);
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((folder / "map.simplemap").string()));
  EXPECT_EQ(map.size(), 4U);
  const std::vector<SimpleMapKeyframe> keyframes = read_simplemap(folder / "map.simplemap");
  ASSERT_EQ(keyframes.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((keyframes[i].T_map_keyframe.matrix() - keyframe(i).T_map_keyframe.matrix()).norm(), 1e-9);
    EXPECT_LT((keyframes[i].covariance - keyframe(i).covariance).norm(), 1e-9);
    EXPECT_EQ(keyframes[i].scan.cloud.points, keyframe(i).scan.cloud.points);
    EXPECT_NEAR(keyframes[i].scan.stamp_s, 50.0 + static_cast<double>(i), 1e-6);
  }
}

TEST(MapExport, SceneIsReadByMrpt) {
  const TemporaryFolder folder;
  SceneContent content;
  content.points = random_cloud(500).points;
  content.colours.assign(500, {10, 20, 30});
  for (std::size_t i = 0; i < 5; ++i) {
    content.trajectory.push_back(pose_from_yaw(0.0, {static_cast<double>(i), 0, 0}));
  }
  content.loops = {{0, 4}};
  write_scene(folder / "map.3Dscene", content);
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile((folder / "map.3Dscene").string()));
  const auto points = scene.getByClass<mrpt::opengl::CPointCloudColoured>();
  const auto lines = scene.getByClass<mrpt::opengl::CSetOfLines>();
  ASSERT_TRUE(points && lines);
  EXPECT_EQ(points->size(), 500U);
  EXPECT_EQ(lines->getLineCount(), 4U);
}

TEST(MapExport, WhatCannotBeWrittenOrReadIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_simplemap(folder / "no/folder/map.simplemap", 1, keyframe), InputError);
  EXPECT_THROW(write_scene(folder / "no/folder/map.3Dscene", {}), InputError);
  folder.write("bad.simplemap", "nothing of the kind");
  EXPECT_THROW(read_simplemap(folder / "bad.simplemap"), InputError);
  EXPECT_THROW(read_simplemap(folder / "missing.simplemap"), InputError);
}

TEST(MapExport, AFailingKeyframeLeavesNoFile) {
  const TemporaryFolder folder;
  const auto failing = [](std::size_t i) -> SimpleMapKeyframe {
    return i < 1 ? keyframe(i) : throw InputError("keyframe 1 is damaged");
  };
  EXPECT_THROW(write_simplemap(folder / "map.simplemap", 3, failing), InputError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace loopmark::mrpt_bridge

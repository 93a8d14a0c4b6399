// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Maps in MRPT's formats, without MRPT's types.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::mrpt_bridge {

/// A keyframe as mrpt::maps::CSimpleMap holds it.
struct SimpleMapKeyframe {
  Pose T_map_keyframe = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in exp(xi) * T_map_keyframe
  Scan scan;
};

/// Writes a .simplemap with `count` keyframes, asked for one after the other: only one is in memory.
void write_simplemap(const std::filesystem::path& path, std::size_t count,
                     const std::function<SimpleMapKeyframe(std::size_t)>& keyframe);

/// The keyframes of a .simplemap. Throws InputError when it cannot be read.
std::vector<SimpleMapKeyframe> read_simplemap(const std::filesystem::path& path);

/// What a .3Dscene shows. `colours` is empty (grey) or as long as `points`.
struct SceneContent {
  std::vector<Pose> trajectory;
  std::vector<Eigen::Vector3f> points;
  std::vector<std::array<std::uint8_t, 3>> colours;
  std::vector<std::array<std::size_t, 2>> loops;  ///< places in `trajectory` joined by a loop closure
};

/// Writes a scene for MRPT's SceneViewer3D: trajectory, loop closures, points, a grid. Needs no display.
void write_scene(const std::filesystem::path& path, const SceneContent& content);

}  // namespace loopmark::mrpt_bridge

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Drives through a small made-up world, for the tests of the set generator.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "loopmark/core/random.hpp"
#include "loopmark/evaluation/candidate_pool.hpp"

namespace loopmark::test {

/// Points all over a square of 240 m, on the ground and above it.
inline std::shared_ptr<const std::vector<Eigen::Vector3f>> small_world() {
  Rng rng(77);
  auto world = std::make_shared<std::vector<Eigen::Vector3f>>();
  for (int i = 0; i < 30000; ++i) {
    world->emplace_back(static_cast<float>(rng.uniform(-120.0, 120.0)), static_cast<float>(rng.uniform(-120.0, 120.0)),
                        static_cast<float>(i % 3 == 0 ? rng.uniform(0.0, 8.0) : 0.0));
  }
  return world;
}

/// A drive of `frames` scans at 10 Hz, 2 m apart, around a circle of 60 m radius (`laps` = frames * 2 / 377), first
/// frame number `first`. Scans see 25 m far.
inline Drive circle_drive(int session, std::size_t frames, int first, double phase, double direction = 1.0) {
  static const auto world = small_world();
  Drive drive;
  drive.session = session;
  drive.name = "circle" + std::to_string(session);
  for (std::size_t i = 0; i < frames; ++i) {
    const double angle = phase + direction * 2.0 * static_cast<double>(i) / 60.0;
    const double wobble = 1.0 + 0.2 * std::sin(3.0 * angle);
    Pose pose = pose_from_yaw(angle + direction * std::numbers::pi / 2.0,
                              {60.0 * wobble * std::cos(angle), 60.0 * wobble * std::sin(angle), 2.0});
    drive.frames.push_back(first + static_cast<int>(i));
    drive.stamps_s.push_back(0.1 * static_cast<double>(i));
    drive.T_world_cloud.push_back(pose);
  }
  const std::vector<Pose> poses = drive.T_world_cloud;
  drive.load = [poses](std::size_t place) {
    PointCloud cloud;
    const Pose T_cloud_world = poses.at(place).inverse();
    for (const Eigen::Vector3f& point : *world) {
      const Eigen::Vector3d moved = T_cloud_world * point.cast<double>();
      if (moved.norm() < 25.0) {
        cloud.points.push_back(moved.cast<float>());
      }
    }
    return cloud;
  };
  return drive;
}

}  // namespace loopmark::test

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Drives through a small made-up world, for the tests of the set generator.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "loopmark/core/random.hpp"
#include "loopmark/pair_sets/candidate_pool.hpp"

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

/// The drive along these poses at 10 Hz, first frame number `first`. Scans see 25 m far.
inline pair_sets::Drive drive_along(int session, const std::string& name, int first, const std::vector<Pose>& poses) {
  static const auto world = small_world();
  pair_sets::Drive drive;
  drive.session = session;
  drive.name = name + std::to_string(session);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    drive.frames.push_back(first + static_cast<int>(i));
    drive.stamps_s.push_back(0.1 * static_cast<double>(i));
  }
  drive.T_world_cloud = poses;
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

/// A drive of `frames` scans, 2 m apart, around a circle of 60 m radius (`laps` = frames * 2 / 377).
inline pair_sets::Drive circle_drive(int session, std::size_t frames, int first, double phase, double direction = 1.0) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < frames; ++i) {
    const double angle = phase + direction * 2.0 * static_cast<double>(i) / 60.0;
    const double wobble = 1.0 + 0.2 * std::sin(3.0 * angle);
    poses.push_back(pose_from_yaw(angle + direction * std::numbers::pi / 2.0,
                                  {60.0 * wobble * std::cos(angle), 60.0 * wobble * std::sin(angle), 2.0}));
  }
  return drive_along(session, "circle", first, poses);
}

/// A drive of `frames` scans, 2 m apart, around a block of 160 m: long straights and short left turns, as streets are.
inline pair_sets::Drive block_drive(int session, std::size_t frames, int first) {
  constexpr std::size_t kStraight = 75;
  constexpr std::size_t kTurn = 5;
  std::vector<Pose> poses;
  Eigen::Vector2d at(-75.0, -80.0);
  double yaw = 0.0;
  for (std::size_t i = 0; i < frames; ++i) {
    poses.push_back(pose_from_yaw(yaw, {at.x(), at.y(), 2.0}));
    yaw += i % (kStraight + kTurn) < kStraight ? 0.0 : std::numbers::pi / 2.0 / kTurn;
    at += 2.0 * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
  }
  return drive_along(session, "block", first, poses);
}

}  // namespace loopmark::test

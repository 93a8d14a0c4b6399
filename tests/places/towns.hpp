// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Made-up places: walls, poles and cars around a sensor, levelled.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "loopmark/core/random.hpp"

namespace loopmark::testing {

struct Wall {
  Eigen::Vector2f from, to;
  float height;
};

/// A segment of town around the origin, 240 m wide.
struct Town {
  std::vector<Wall> walls;

  explicit Town(std::uint64_t seed) {
    Rng rng(seed);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector2f at(static_cast<float>(rng.uniform(-110, 110)), static_cast<float>(rng.uniform(-110, 110)));
      const bool along = rng.uniform() < 0.5;
      const auto length = static_cast<float>(rng.uniform(1.0, 30.0));
      walls.push_back({at, at + length * (along ? Eigen::Vector2f::UnitX() : Eigen::Vector2f::UnitY()),
                       static_cast<float>(rng.uniform(1.0, 7.0))});
    }
  }

  /// Adds small things that another day would not show again.
  void park_cars(std::uint64_t seed, int count) {
    Rng rng(seed);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2f at(static_cast<float>(rng.uniform(-90, 90)), static_cast<float>(rng.uniform(-90, 90)));
      walls.push_back({at, at + Eigen::Vector2f(4.0F, 0.0F), 1.5F});
    }
  }

  /// What a sensor at (x, y) that looks towards `yaw` sees within 100 m, in its own levelled frame.
  std::vector<Eigen::Vector3f> seen_from(float x, float y, double yaw, float spacing = 0.3F) const {
    const Eigen::Rotation2Df turn(static_cast<float>(-yaw));
    std::vector<Eigen::Vector3f> points;
    for (const Wall& wall : walls) {
      const Eigen::Vector2f d = wall.to - wall.from;
      for (float s = 0.0F; s < d.norm(); s += spacing) {
        const Eigen::Vector2f p = turn * (wall.from + d.normalized() * s - Eigen::Vector2f(x, y));
        for (float z = 0.0F; z < wall.height && p.norm() < 100.0F; z += spacing) {
          points.emplace_back(p.x(), p.y(), z);
        }
      }
    }
    return points;
  }
};

}  // namespace loopmark::testing

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A little world of ground and boxes, and a spinning sensor in it, for tests: exact rays, no noise unless asked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::testing_support {

struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

struct BoxWorld {
  std::vector<Box> boxes;

  /// Distance along a ray to the ground (z = 0) or a box, or infinity.
  double range(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
    double best = direction.z() < 0.0 ? -from.z() / direction.z() : std::numeric_limits<double>::infinity();
    for (const Box& box : boxes) {
      const Eigen::Array3d a = (box.low - from).array() / direction.array();
      const Eigen::Array3d b = (box.high - from).array() / direction.array();
      const double enter = a.min(b).maxCoeff();
      const double leave = a.max(b).minCoeff();
      if (enter > 0.0 && enter < leave) {
        best = std::min(best, enter);
      }
    }
    return best;
  }
};

/// A street along x with house fronts, recesses and poles on both sides; different at every place.
inline BoxWorld street(double length_m, std::uint64_t seed) {
  BoxWorld world;
  Rng rng(seed);
  for (const double side : {-1.0, 1.0}) {
    for (double x = -60.0; x < length_m + 60.0;) {
      const double width = rng.uniform(4.0, 11.0);
      const double front = rng.uniform(7.0, 10.0);
      const double near = side * front;
      const double far = side * (front + 8.0);
      world.boxes.push_back({{x, std::min(near, far), 0.0}, {x + width, std::max(near, far), rng.uniform(4.0, 12.0)}});
      const double pole = x + rng.uniform(0.0, width);
      const double y = side * rng.uniform(5.0, 6.0);
      world.boxes.push_back({{pole, y - 0.15, 0.0}, {pole + 0.3, y + 0.15, 5.0}});
      x += width + rng.uniform(0.0, 4.0);
    }
  }
  return world;
}

/// Level land along x with nothing on it but posts, one about every `apart_m` metres, on either side.
inline BoxWorld open_land(double length_m, double apart_m, std::uint64_t seed) {
  BoxWorld world;
  Rng rng(seed);
  for (double x = -80.0; x < length_m + 80.0; x += rng.uniform(0.6, 1.4) * apart_m) {
    const double side = rng.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
    const double y = side * rng.uniform(6.0, 12.0);
    world.boxes.push_back({{x, y - 0.15, 0.0}, {x + 0.3, y + 0.15, rng.uniform(3.0, 6.0)}});
  }
  return world;
}

/// What a clockwise spinning sensor with its seam behind and its stamp in the middle of the sweep sees from
/// T_world_lidar (at the stamp) while it moves with `velocity` (a second, in its own frame).
inline PointCloud sweep(const BoxWorld& world, const Pose& T_world_lidar, const Vector6d& velocity,
                        double noise_m = 0.0, std::uint64_t seed = 0, int beams = 24, int columns = 720) {
  constexpr double kPeriod = 0.1;
  constexpr double kFarthest = 80.0;
  PointCloud cloud;
  Rng rng(seed);
  for (int column = 0; column < columns; ++column) {
    const double turned = (column + 0.5) / columns;
    const double azimuth = M_PI - 2.0 * M_PI * turned;
    const double time = (turned - 0.5) * kPeriod;
    const Pose T = T_world_lidar * exp_se3(time * velocity);
    for (int beam = 0; beam < beams; ++beam) {
      const double elevation = (-25.0 + 35.0 * beam / (beams - 1)) * M_PI / 180.0;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation));
      const double range = world.range(T.translation(), T.linear() * direction) + noise_m * rng.normal();
      if (range > 1.0 && range < kFarthest) {
        cloud.points.push_back((range * direction).cast<float>());
        cloud.time_offset_s.push_back(static_cast<float>(time));
        cloud.intensity.push_back(static_cast<float>(beam));
      }
    }
  }
  return cloud;
}

}  // namespace loopmark::testing_support

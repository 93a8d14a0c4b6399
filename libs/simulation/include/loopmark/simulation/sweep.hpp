// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/simulation/drive.hpp"
#include "loopmark/simulation/world.hpp"

namespace loopmark::simulation {

/// In what frame the points of a sweep are given.
enum class Motion {
  kRaw,          ///< each in the sensor's frame at its own moment, as a sensor delivers them
  kCompensated,  ///< all in the sensor's frame at the stamp
};

/// T_world_lidar at a time relative to the stamp of the sweep, seconds.
using SensorMotion = std::function<Pose(double)>;

/// Fires every beam of one sweep at its own moment from where the sensor then is. Points carry intensity (0 to 1), time
/// relative to the stamp, and ring. Noise and dropout depend on `seed` only.
PointCloud render_sweep(const World& world, const World::Moving* moving, const SensorModel& sensor,
                        const SensorMotion& motion, Motion frame, std::uint64_t seed);

/// Sweep `index` of a drive.
Scan render_scan(const World& world, const Drive& drive, std::size_t index, Motion frame = Motion::kRaw);

/// A sweep from a standing sensor.
PointCloud render_standing(const World& world, const World::Moving* moving, const SensorModel& sensor,
                           const Pose& T_world_lidar, std::uint64_t seed);

}  // namespace loopmark::simulation

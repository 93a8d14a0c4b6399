// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_sink.hpp"

namespace loopmark::packets::internal {

void start_sweep(SweepCloud& sweep, std::int64_t time_ns, double sensor_s) {
  if (!sweep.started) {
    sweep.started = true;
    sweep.start_ns = time_ns;
    sweep.start_sensor_s = sensor_s;
  }
}

double sensor_seconds(const SweepCloud& sweep, double sensor_s, double wrap_s) {
  const double since = sensor_s - sweep.start_sensor_s;
  return since < -0.5 * wrap_s ? since + wrap_s : since;
}

void add_point(SweepCloud& sweep, const Laser& laser, double angle_rad, double distance_m, double intensity,
               double time_s) {
  const double angle = angle_rad + laser.azimuth_rad;
  const double flat = distance_m * std::cos(laser.elevation_rad) - laser.vertical_m * std::sin(laser.elevation_rad);
  // Clockwise angles: y is to the left.
  sweep.cloud.points.emplace_back(static_cast<float>(flat * std::cos(angle) + laser.horizontal_m * std::sin(angle)),
                                  static_cast<float>(-flat * std::sin(angle) + laser.horizontal_m * std::cos(angle)),
                                  static_cast<float>(distance_m * std::sin(laser.elevation_rad) +
                                                     laser.vertical_m * std::cos(laser.elevation_rad)));
  sweep.cloud.intensity.push_back(static_cast<float>(intensity));
  sweep.cloud.ring.push_back(laser.ring);
  sweep.cloud.time_offset_s.push_back(static_cast<float>(time_s));
}

}  // namespace loopmark::packets::internal

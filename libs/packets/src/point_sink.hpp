// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the decoders have in common: numbers of a packet, cuts of a rotation, points of a beam.
#pragma once

#include <cmath>
#include <cstring>

#include "velodyne.hpp"

namespace loopmark::packets::internal {

/// A little-endian number; the caller has held the packet's size against its layout.
template <class T>
T number(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// The first block whose angle is past the sensor's zero while the one before was not. Small steps back (blocks of one
/// firing, noise of the encoder) are none.
template <class Angle>
std::optional<std::size_t> cut_by_angle(std::size_t blocks, const Angle& angle_deg, CutState& state) {
  std::optional<std::size_t> found;
  for (std::size_t block = 0; block < blocks; ++block) {
    const double angle = angle_deg(block);
    if (state.angle_deg && *state.angle_deg - angle > 180.0 && !found) {
      found = block;
    }
    state.angle_deg = angle;
  }
  return found;
}

/// Two returns of one firing this near are one echo: where there is only one it is sent again, and pulses (some ns
/// long) that overlap cannot be told apart.
inline bool same_echo(std::uint16_t first, std::uint16_t second, double unit_m) {
  constexpr double kApart_m = 0.1;
  return first != 0 && std::abs(first - second) * unit_m < kApart_m;
}

/// Notes the clocks at the first packet of a sweep.
void start_sweep(SweepCloud& sweep, std::int64_t time_ns, double sensor_s);

/// Seconds by the sensor's clock since the sweep's first packet; the clock starts again every `wrap_s`.
double sensor_seconds(const SweepCloud& sweep, double sensor_s, double wrap_s);

/// Adds the point at `distance_m` on a laser's beam; `angle_rad` is the rotation, clockwise from the front.
void add_point(SweepCloud& sweep, const Laser& laser, double angle_rad, double distance_m, double intensity,
               double time_s);

}  // namespace loopmark::packets::internal

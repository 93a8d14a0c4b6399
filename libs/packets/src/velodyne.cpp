// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "velodyne.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "point_sink.hpp"

namespace loopmark::packets::internal {
namespace {

constexpr std::size_t kBlockBytes = 100;  // flag, azimuth, 32 returns of 3 bytes
constexpr std::size_t kReturns = 32;
constexpr std::size_t kTimestamp = 1200, kReturnMode = 1204;
constexpr unsigned char kDual = 0x39;

std::uint16_t flag_of(std::string_view bytes, std::size_t block) {
  return number<std::uint16_t>(bytes, block * kBlockBytes);
}

double azimuth_deg(std::string_view bytes, std::size_t block) {
  return 0.01 * number<std::uint16_t>(bytes, block * kBlockBytes + 2);
}

/// The bank of lasers that a block's flag names: 0xEEFF the first, then 0xDDFF, 0xCCFF, 0xBBFF.
std::size_t bank_of(std::uint16_t flag) {
  switch (flag) {
    case 0xDDFF:
      return 1;
    case 0xCCFF:
      return 2;
    case 0xBBFF:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

bool VelodyneDecoder::accepts(std::string_view bytes) const {
  return bytes.size() == kBytes && flag_of(bytes, 0) == 0xEEFF;
}

bool VelodyneDecoder::dual(std::string_view bytes) const {
  return static_cast<unsigned char>(bytes[kReturnMode]) == kDual;
}

std::optional<std::size_t> VelodyneDecoder::cut(std::string_view bytes, CutState& state) const {
  return cut_by_angle(
      kBlocks, [&](std::size_t block) { return azimuth_deg(bytes, block); }, state);
}

/// How far the sensor turns from this block's firing to the next one's.
double VelodyneDecoder::gap_deg(std::string_view bytes, std::size_t block) const {
  const std::size_t step = static_cast<std::size_t>(model_.banks) * (dual(bytes) ? 2 : 1);
  const std::size_t at = block + step < kBlocks ? block : block - std::min(block, step);
  const double gap =
      std::fmod(azimuth_deg(bytes, std::min(at + step, kBlocks - 1)) - azimuth_deg(bytes, at) + 360.0, 360.0);
  return gap < 5.0 ? gap : 0.0;  // the sensor turns by at most 2 degrees; more is a gap in the data
}

/// When a laser shoots, from the beginning of its firing.
double VelodyneDecoder::laser_seconds(std::size_t laser) const {
  const std::size_t group = laser / static_cast<std::size_t>(model_.lasers_at_once);
  const std::size_t idle = model_.idle_after > 0 ? group / model_.idle_after : 0;
  return static_cast<double>(group + idle) * model_.laser_step_s;
}

void VelodyneDecoder::decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const {
  start_sweep(sweep, packet.time_ns, 1e-6 * number<std::uint32_t>(packet.bytes, kTimestamp));
  for (std::size_t block = begin; block < std::min(end, kBlocks); ++block) {
    decode_block(packet, block, sweep);
  }
}

void VelodyneDecoder::decode_block(const Packet& packet, std::size_t block, SweepCloud& sweep) const {
  const std::size_t bank = bank_of(flag_of(packet.bytes, block));
  if (flag_of(packet.bytes, block) != 0xEEFF && bank == 0) {
    return;  // not a block of returns
  }
  const std::size_t in_firing = static_cast<std::size_t>(model_.banks) * (dual(packet.bytes) ? 2 : 1);
  const double block_s = static_cast<double>(block / in_firing) * model_.firings_in_block * model_.firing_cycle_s;
  const double packet_s = sensor_seconds(sweep, 1e-6 * number<std::uint32_t>(packet.bytes, kTimestamp), 3600.0);
  const double azimuth = azimuth_deg(packet.bytes, block);
  const double turn_deg_s = gap_deg(packet.bytes, block) / (model_.firings_in_block * model_.firing_cycle_s);
  const std::size_t lasers = kReturns / static_cast<std::size_t>(model_.firings_in_block);
  for (std::size_t r = 0; r < kReturns; ++r) {
    const std::size_t at = block * kBlockBytes + 4 + 3 * r;
    const std::size_t number_of_laser = bank * kReturns + r % lasers;
    const auto raw = number<std::uint16_t>(packet.bytes, at);
    if (raw == 0 || number_of_laser >= model_.lasers.size()) {
      sweep.without_echo += raw == 0 ? 1 : 0;
      continue;
    }
    if (dual(packet.bytes) && block % 2 == 1 &&
        same_echo(number<std::uint16_t>(packet.bytes, at - kBlockBytes), raw, model_.distance_unit_m)) {
      continue;
    }
    const double in_block_s = static_cast<double>(r / lasers) * model_.firing_cycle_s + laser_seconds(number_of_laser);
    const Laser& laser = model_.lasers[number_of_laser];
    const double angle = (azimuth + turn_deg_s * in_block_s) * std::numbers::pi / 180.0;
    add_point(sweep, laser, angle, raw * model_.distance_unit_m + laser.distance_m,
              static_cast<unsigned char>(packet.bytes[at + 2]), packet_s + block_s + in_block_s);
  }
}

}  // namespace loopmark::packets::internal

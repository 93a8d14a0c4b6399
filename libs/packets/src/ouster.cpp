// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ouster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "point_sink.hpp"

namespace loopmark::packets::internal {
namespace {

constexpr double kGravity_m_s2 = 9.80665;  // the IMU counts in it

constexpr std::array kProfiles = {
    OusterProfile{"LEGACY", 12, 4, 0x000FFFFF, 0, 6, 2, 0, 0},
    OusterProfile{"RNG19_RFL8_SIG16_NIR16", 12, 4, 0x0007FFFF, 0, 6, 2, 0, 0},
    OusterProfile{"RNG19_RFL8_SIG16_NIR16_DUAL", 16, 4, 0x0007FFFF, 0, 8, 2, 4, 10},
    OusterProfile{"RNG15_RFL8_NIR8", 4, 2, 0x7FFF, 3, 2, 1, 0, 0},
    OusterProfile{"FUSA_RNG15_RFL8_NIR8_DUAL", 8, 2, 0x7FFF, 3, 2, 1, 4, 6},
    OusterProfile{"RNG15_RFL8_NIR8_DUAL", 8, 2, 0x7FFF, 3, 2, 1, 4, 6},
    OusterProfile{"FIVE_WORD_PIXEL", 20, 4, 0x0007FFFF, 0, 8, 2, 0, 0},
};

OusterProfile profile_called(const std::string& name) {
  std::string known;
  for (const OusterProfile& profile : kProfiles) {
    if (name == profile.name) {
      return profile;
    }
    known += (known.empty() ? "" : ", ") + std::string(profile.name);
  }
  throw InputError("the sensor sends the profile '" + name + "', which is none of " + known);
}

/// A range in millimetres at `at`.
std::uint32_t range_at(std::string_view bytes, std::size_t at, const OusterProfile& p) {
  const std::uint32_t word = p.range_bytes == 2 ? number<std::uint16_t>(bytes, at) : number<std::uint32_t>(bytes, at);
  return (word & p.range_mask) << p.range_shift;
}

double intensity_at(std::string_view bytes, std::size_t at, const OusterProfile& p) {
  return p.intensity_bytes == 2 ? number<std::uint16_t>(bytes, at) : static_cast<unsigned char>(bytes[at]);
}

}  // namespace

OusterDecoder::OusterDecoder(OusterMetadata metadata)
    : metadata_(std::move(metadata)), profile_(profile_called(metadata_.profile)) {}

std::size_t OusterDecoder::column_bytes() const {
  return column_head() + metadata_.rows * profile_.pixel + (legacy() ? 4 : 0);
}

std::size_t OusterDecoder::measurement(std::string_view bytes, std::size_t column) const {
  return number<std::uint16_t>(bytes, column_at(column) + 8);
}

bool OusterDecoder::valid(std::string_view bytes, std::size_t column) const {
  const std::size_t at = column_at(column);
  return legacy() ? number<std::uint32_t>(bytes, at + column_bytes() - 4) != 0
                  : (number<std::uint16_t>(bytes, at + 10) & 1U) != 0;
}

std::uint32_t OusterDecoder::range_mm(std::string_view bytes, std::size_t column, std::size_t row) const {
  return range_at(bytes, column_at(column) + column_head() + row * profile_.pixel, profile_);
}

/// A frame has a number of its own; packets of the frame before that come late do not begin a new one.
std::optional<std::size_t> OusterDecoder::cut(std::string_view bytes, CutState& state) const {
  const bool fusa = metadata_.profile.rfind("FUSA", 0) == 0;
  const std::uint32_t frame = legacy() ? number<std::uint16_t>(bytes, 10)
                              : fusa   ? number<std::uint32_t>(bytes, 4)
                                       : number<std::uint16_t>(bytes, 2);
  const bool late = state.frame && static_cast<std::uint16_t>(*state.frame - frame) == 1;
  if (late) {
    return std::nullopt;
  }
  const bool begins = state.frame && frame != *state.frame;
  state.frame = frame;
  return begins ? std::optional<std::size_t>(0) : std::nullopt;
}

void OusterDecoder::decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const {
  const auto first = number<std::uint64_t>(packet.bytes, column_at(0));
  start_sweep(sweep, packet.time_ns, 1e-9 * static_cast<double>(first));
  for (std::size_t column = begin; column < std::min(end, metadata_.columns_in_packet); ++column) {
    const std::size_t m = measurement(packet.bytes, column);
    if (!valid(packet.bytes, column) || m >= metadata_.columns) {
      continue;
    }
    const double stamp = 1e-9 * static_cast<double>(number<std::uint64_t>(packet.bytes, column_at(column)));
    const double time_s = stamp - sweep.start_sensor_s;
    for (std::size_t row = 0; row < metadata_.rows; ++row) {
      const std::size_t at = column_at(column) + column_head() + row * profile_.pixel;
      add_return(sweep, row, m, 1e-3 * range_at(packet.bytes, at, profile_),
                 intensity_at(packet.bytes, at + profile_.intensity, profile_), time_s);
      if (profile_.second > 0 && range_at(packet.bytes, at + profile_.second, profile_) > 0) {
        add_return(sweep, row, m, 1e-3 * range_at(packet.bytes, at + profile_.second, profile_),
                   intensity_at(packet.bytes, at + profile_.second_intensity, profile_), time_s);
      }
    }
  }
}

/// "Lidar range to XYZ" of the firmware manual: the beam begins beside the axis and leans by its azimuth.
void OusterDecoder::add_return(SweepCloud& sweep, std::size_t row, std::size_t column, double range_m, double intensity,
                               double time_s) const {
  if (range_m <= 0.0) {
    ++sweep.without_echo;
    return;
  }
  const double encoder =
      2.0 * std::numbers::pi * (1.0 - static_cast<double>(column) / static_cast<double>(metadata_.columns));
  const double azimuth = encoder - metadata_.azimuth_rad[row];
  const double elevation = metadata_.elevation_rad[row];
  const double along = range_m - metadata_.beam_origin_m;
  const Eigen::Vector3d in_lidar(
      along * std::cos(azimuth) * std::cos(elevation) + metadata_.beam_origin_m * std::cos(encoder),
      along * std::sin(azimuth) * std::cos(elevation) + metadata_.beam_origin_m * std::sin(encoder),
      along * std::sin(elevation));
  sweep.cloud.points.push_back((metadata_.T_sensor_lidar * in_lidar).cast<float>());
  sweep.cloud.intensity.push_back(static_cast<float>(intensity));
  sweep.cloud.ring.push_back(static_cast<std::uint16_t>(metadata_.rows - 1 - row));  // rows count from above
  sweep.cloud.time_offset_s.push_back(static_cast<float>(time_s));
}

}  // namespace loopmark::packets::internal

namespace loopmark::packets {

std::unique_ptr<PacketDecoder> make_ouster_decoder(const std::filesystem::path& metadata) {
  return std::make_unique<internal::OusterDecoder>(internal::read_ouster_metadata(metadata));
}

bool looks_like_ouster(std::string_view bytes) {
  for (const internal::OusterProfile& profile : internal::kProfiles) {
    const bool legacy = std::string_view(profile.name) == "LEGACY";
    for (const std::size_t rows : {16, 32, 64, 128}) {
      const std::size_t columns = 16 * ((legacy ? 20 : 12) + rows * profile.pixel);
      if (bytes.size() == columns + (legacy ? 0 : 64)) {
        return true;
      }
    }
  }
  return false;
}

std::optional<OusterImu> read_ouster_imu(std::string_view bytes) {
  if (bytes.size() != 48) {
    return std::nullopt;
  }
  const auto value = [&](std::size_t i) { return static_cast<double>(internal::number<float>(bytes, 24 + 4 * i)); };
  OusterImu imu;
  imu.sensor_ns = internal::number<std::uint64_t>(bytes, 8);
  imu.acceleration_m_s2 = internal::kGravity_m_s2 * Eigen::Vector3d(value(0), value(1), value(2));
  imu.angular_velocity_rad_s = std::numbers::pi / 180.0 * Eigen::Vector3d(value(3), value(4), value(5));
  return imu;
}

}  // namespace loopmark::packets

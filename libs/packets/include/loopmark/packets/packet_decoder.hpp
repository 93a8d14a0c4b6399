// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Packets of spinning LiDARs as they come over the wire, to points in the sensor's frame: x forward, y left, z up.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::packets {

/// One datagram's content and when it was received, since 1970.
struct Packet {
  std::int64_t time_ns = 0;
  std::string_view bytes;
};

/// The points of a sweep in the making. Times are counted from the first packet.
struct SweepCloud {
  PointCloud cloud;
  std::size_t without_echo = 0;  ///< firings that nothing answered
  std::int64_t start_ns = 0;     ///< when the first packet was received; PointCloud::time_offset_s counts from it
  double start_sensor_s = 0.0;   ///< the same by the sensor's clock
  bool started = false;
};

/// Where the sensor was when it was looked at last: its rotation's angle or frame.
struct CutState {
  std::optional<double> angle_deg;
  std::optional<std::uint32_t> frame;
};

class PacketDecoder {
 public:
  virtual ~PacketDecoder() = default;
  /// "VLP-16".
  virtual std::string sensor() const = 0;
  /// True when the bytes are a packet of points of this sensor.
  virtual bool accepts(std::string_view bytes) const = 0;
  /// Blocks of firings in a packet.
  virtual std::size_t blocks(std::string_view bytes) const = 0;
  /// The block with which the sensor begins a new sweep; nothing where the packet goes on with the last one.
  virtual std::optional<std::size_t> cut(std::string_view bytes, CutState& state) const = 0;
  /// Adds the points of the blocks [begin, end).
  virtual void decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const = 0;
};

/// The decoder for a packet's maker and model, or nullptr where it is none that is known. `calibration`: the file that
/// belongs to the sensor; may be empty. Throws InputError where the model needs it, or it cannot be understood.
std::unique_ptr<PacketDecoder> make_decoder(std::string_view packet, const std::filesystem::path& calibration);

/// Ouster's packets do not say of which model and mode they are: the sensor's metadata (JSON) does. Throws InputError
/// naming what is missing in it or contradicts itself.
std::unique_ptr<PacketDecoder> make_ouster_decoder(const std::filesystem::path& metadata);

/// True when the bytes are, by their size, a packet of an Ouster sensor whose metadata is needed.
bool looks_like_ouster(std::string_view bytes);

/// An Ouster IMU packet: acceleration in m/s^2 and angular velocity in rad/s; nothing for other packets.
struct OusterImu {
  std::uint64_t sensor_ns = 0;
  Eigen::Vector3d acceleration_m_s2, angular_velocity_rad_s;
};
std::optional<OusterImu> read_ouster_imu(std::string_view bytes);

}  // namespace loopmark::packets

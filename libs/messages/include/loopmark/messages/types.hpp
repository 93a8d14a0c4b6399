// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The messages of ROS that say something of a drive, with their fields in the order of their definitions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace loopmark::messages {

/// std_msgs/Header.
struct Header {
  std::uint32_t sequence = 0;  ///< ROS 1 only
  std::int32_t seconds = 0;    ///< since 1970; ROS 1 counts them unsigned, up to 2106
  std::uint32_t nanoseconds = 0;
  std::string frame_id;

  std::int64_t stamp_ns() const {
    return static_cast<std::int64_t>(static_cast<std::uint32_t>(seconds)) * 1'000'000'000 + nanoseconds;
  }
  void set_stamp_ns(std::int64_t stamp_ns) {
    seconds = static_cast<std::int32_t>(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    nanoseconds = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
  }
};
template <class Wire>
void fields(Wire& w, Header& m) {
  if (w.ros1()) {
    w(m.sequence);
  }
  w(m.seconds);
  w(m.nanoseconds);
  w(m.frame_id);
}

/// sensor_msgs/PointField; datatypes: 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32, 7 float32, 8 float64.
struct PointField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 7;
  std::uint32_t count = 1;
};
template <class Wire>
void fields(Wire& w, PointField& m) {
  w(m.name);
  w(m.offset);
  w(m.datatype);
  w(m.count);
}

/// sensor_msgs/PointCloud2; `data` is a view into the message's bytes.
struct PointCloud2 {
  Header header;
  std::uint32_t height = 1, width = 0;
  std::vector<PointField> point_fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::string_view data;
  bool dense = true;
};
template <class Wire>
void fields(Wire& w, PointCloud2& m) {
  w(m.header);
  w(m.height);
  w(m.width);
  w(m.point_fields);
  w(m.big_endian);
  w(m.point_step);
  w(m.row_step);
  w.bytes(m.data);
  w(m.dense);
}

/// sensor_msgs/Imu: rad/s and m/s^2 in the IMU's frame; covariance[0] = -1: not measured.
struct Imu {
  Header header;
  std::array<double, 4> orientation_xyzw{0.0, 0.0, 0.0, 1.0};
  std::array<double, 9> orientation_covariance{};
  std::array<double, 3> angular_velocity{};
  std::array<double, 9> angular_velocity_covariance{};
  std::array<double, 3> linear_acceleration{};
  std::array<double, 9> linear_acceleration_covariance{};
};
template <class Wire>
void fields(Wire& w, Imu& m) {
  w(m.header);
  w(m.orientation_xyzw);
  w(m.orientation_covariance);
  w(m.angular_velocity);
  w(m.angular_velocity_covariance);
  w(m.linear_acceleration);
  w(m.linear_acceleration_covariance);
}

/// sensor_msgs/NavSatFix: degrees and metres above the WGS 84 ellipsoid; status -1 no fix, 0 fix, 1 SBAS, 2 GBAS (RTK).
struct NavSatFix {
  Header header;
  std::int8_t status = 0;
  std::uint16_t service = 1;
  double latitude_deg = 0.0, longitude_deg = 0.0, altitude_m = 0.0;
  std::array<double, 9> covariance_m2{};  ///< east, north, up
  std::uint8_t covariance_type = 0;       ///< 0: unknown
};
template <class Wire>
void fields(Wire& w, NavSatFix& m) {
  w(m.header);
  w(m.status);
  w(m.service);
  w(m.latitude_deg);
  w(m.longitude_deg);
  w(m.altitude_m);
  w(m.covariance_m2);
  w(m.covariance_type);
}

/// geometry_msgs/Pose or Transform: both have a position, then a quaternion.
struct PoseFields {
  std::array<double, 3> position{};
  std::array<double, 4> orientation_xyzw{0.0, 0.0, 0.0, 1.0};
};
template <class Wire>
void fields(Wire& w, PoseFields& m) {
  w(m.position);
  w(m.orientation_xyzw);
}

/// geometry_msgs/PoseStamped.
struct PoseStamped {
  Header header;
  PoseFields pose;
};
template <class Wire>
void fields(Wire& w, PoseStamped& m) {
  w(m.header);
  w(m.pose);
}

/// nav_msgs/Path.
struct Path {
  Header header;
  std::vector<PoseStamped> poses;
};
template <class Wire>
void fields(Wire& w, Path& m) {
  w(m.header);
  w(m.poses);
}

/// nav_msgs/Odometry: the pose of child_frame_id in header.frame_id, the twist in child_frame_id.
struct Odometry {
  Header header;
  std::string child_frame_id;
  PoseFields pose;
  std::array<double, 36> pose_covariance{};
  std::array<double, 6> twist{};
  std::array<double, 36> twist_covariance{};
};
template <class Wire>
void fields(Wire& w, Odometry& m) {
  w(m.header);
  w(m.child_frame_id);
  w(m.pose);
  w(m.pose_covariance);
  w(m.twist);
  w(m.twist_covariance);
}

/// geometry_msgs/TransformStamped: T_header.frame_id_child_frame_id.
struct TransformStamped {
  Header header;
  std::string child_frame_id;
  PoseFields transform;
};
template <class Wire>
void fields(Wire& w, TransformStamped& m) {
  w(m.header);
  w(m.child_frame_id);
  w(m.transform);
}

/// tf2_msgs/TFMessage.
struct TransformMessage {
  std::vector<TransformStamped> transforms;
};
template <class Wire>
void fields(Wire& w, TransformMessage& m) {
  w(m.transforms);
}

/// livox_ros_driver(2)/CustomMsg.
struct LivoxPoint {
  std::uint32_t offset_ns = 0;  ///< since LivoxScan::timebase_ns
  float x = 0.0F, y = 0.0F, z = 0.0F;
  std::uint8_t reflectivity = 0, tag = 0, line = 0;
};
template <class Wire>
void fields(Wire& w, LivoxPoint& m) {
  w(m.offset_ns);
  w(m.x);
  w(m.y);
  w(m.z);
  w(m.reflectivity);
  w(m.tag);
  w(m.line);
}
struct LivoxScan {
  Header header;
  std::uint64_t timebase_ns = 0;
  std::uint32_t count = 0;
  std::uint8_t lidar_id = 0;
  std::array<std::uint8_t, 3> reserved{};
  std::vector<LivoxPoint> points;
};
template <class Wire>
void fields(Wire& w, LivoxScan& m) {
  w(m.header);
  w(m.timebase_ns);
  w(m.count);
  w(m.lidar_id);
  w(m.reserved);
  w(m.points);
}

/// velodyne_msgs/VelodynePacket (1206 bytes) and pandar_msgs/PandarPacket (1500 bytes, of which `size` count).
template <std::size_t Bytes, bool HasSize>
struct SensorPacket {
  std::uint32_t seconds = 0, nanoseconds = 0;
  std::string_view data;
  std::uint32_t size = Bytes;
};
template <class Wire, std::size_t Bytes, bool HasSize>
void fields(Wire& w, SensorPacket<Bytes, HasSize>& m) {
  w(m.seconds);
  w(m.nanoseconds);
  w.bytes(m.data, Bytes);
  if (HasSize) {
    w(m.size);
  }
}
template <std::size_t Bytes, bool HasSize>
struct PacketScan {
  Header header;
  std::vector<SensorPacket<Bytes, HasSize>> packets;
};
template <class Wire, std::size_t Bytes, bool HasSize>
void fields(Wire& w, PacketScan<Bytes, HasSize>& m) {
  w(m.header);
  w(m.packets);
}
using VelodyneScan = PacketScan<1206, false>;
using PandarScan = PacketScan<1500, true>;

}  // namespace loopmark::messages

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_log_writer.hpp"

#include <cmath>
#include <cstring>

#include "loopmark/messages/definitions.hpp"
#include "loopmark/messages/types.hpp"
#include "recording_observations.hpp"

namespace loopmark::io::internal {
namespace {

constexpr const char* kLidarFrame = "lidar";

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(std::llround(1e9 * seconds)); }

messages::Header header_of(double stamp_s, const std::string& frame_id) {
  messages::Header header;
  header.set_stamp_ns(nanoseconds(stamp_s));
  header.frame_id = frame_id;
  return header;
}

messages::PoseFields fields_of(const Pose& pose) {
  const Eigen::Quaterniond q(pose.rotation());
  const Eigen::Vector3d t = pose.translation();
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

std::array<double, 3> array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// One channel of the points at its place in each of them.
template <class T>
void put_column(std::string& data, std::size_t step, std::size_t at, const std::vector<T>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::memcpy(data.data() + i * step + at, &values[i], sizeof(T));
  }
}

}  // namespace

std::string encode_cloud(messages::Encoding encoding, const Scan& scan, const std::string& frame_id) {
  const PointCloud& cloud = scan.cloud;
  messages::PointCloud2 m;
  m.header = header_of(scan.stamp_s, frame_id);
  m.width = static_cast<std::uint32_t>(cloud.size());
  m.point_fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}};
  std::uint32_t step = 12;
  const auto add_field = [&](bool there, const char* name, std::uint8_t type, std::uint32_t size) {
    if (there) {
      m.point_fields.push_back({name, step, type, 1});
      step += size;
    }
    return step - size;
  };
  const std::uint32_t intensity = add_field(!cloud.intensity.empty(), "intensity", 7, 4);
  const std::uint32_t time = add_field(!cloud.time_offset_s.empty(), "time", 7, 4);
  const std::uint32_t ring = add_field(!cloud.ring.empty(), "ring", 4, 2);
  m.point_step = step;
  m.row_step = step * m.width;
  std::string data(std::size_t{m.row_step}, '\0');
  put_column(data, step, 0, cloud.points);
  put_column(data, step, intensity, cloud.intensity);
  put_column(data, step, time, cloud.time_offset_s);
  put_column(data, step, ring, cloud.ring);
  m.data = data;
  return messages::encode(encoding, m);
}

std::uint32_t RecordingLogWriter::channel(const std::string& topic, const std::string& type) {
  const auto known = channels_.find(topic);
  if (known != channels_.end()) {
    return known->second;
  }
  const std::uint32_t number = writer_->add_channel(
      {topic, type, encoding_, "", messages::definition_text(type, encoding_ == messages::Encoding::kRos1),
       messages::definition_md5(type)});
  channels_[topic] = number;
  return number;
}

void RecordingLogWriter::write_mounts(std::int64_t time_ns) {
  messages::TransformMessage m;
  for (const auto& [frame, T_lidar_frame] : mounts_) {
    if (frame != kLidarFrame) {
      m.transforms.push_back(
          {header_of(1e-9 * static_cast<double>(time_ns), kLidarFrame), frame, fields_of(T_lidar_frame)});
    }
  }
  mounts_.clear();
  if (!m.transforms.empty()) {
    writer_->write(channel("/tf_static", "tf2_msgs/TFMessage"), time_ns, messages::encode(encoding_, m));
  }
}

void RecordingLogWriter::add(const Scan& scan, const std::optional<Pose>& T_world_lidar) {
  const std::int64_t time_ns = nanoseconds(scan.stamp_s);
  write_mounts(time_ns);
  writer_->write(channel("/points", "sensor_msgs/PointCloud2"), time_ns, encode_cloud(encoding_, scan, kLidarFrame));
  if (T_world_lidar) {
    messages::Odometry m;
    m.header = header_of(scan.stamp_s, "world");
    m.child_frame_id = kLidarFrame;
    m.pose = fields_of(*T_world_lidar);
    writer_->write(channel(kTruthTopic, "nav_msgs/Odometry"), time_ns, messages::encode(encoding_, m));
  }
}

void RecordingLogWriter::add(const Observation& observation) {
  if (const auto* imu = std::get_if<ImuSample>(&observation)) {
    messages::Imu m;
    m.header = header_of(imu->source.stamp_s, imu->source.frame_id);
    m.angular_velocity = array_of(imu->angular_velocity_rad_s);
    m.linear_acceleration = array_of(imu->linear_acceleration_m_s2);
    m.orientation_covariance[0] = imu->orientation ? 0.0 : -1.0;
    if (imu->orientation) {
      m.orientation_xyzw = {imu->orientation->x(), imu->orientation->y(), imu->orientation->z(), imu->orientation->w()};
    }
    writer_->write(channel(imu->source.topic, "sensor_msgs/Imu"), nanoseconds(imu->source.stamp_s),
                   messages::encode(encoding_, m));
  } else if (const auto* fix = std::get_if<GnssFix>(&observation)) {
    messages::NavSatFix m;
    m.header = header_of(fix->source.stamp_s, fix->source.frame_id);
    m.status = static_cast<std::int8_t>(fix->status);
    m.latitude_deg = fix->latitude_deg;
    m.longitude_deg = fix->longitude_deg;
    m.altitude_m = fix->altitude_m;
    m.covariance_type = fix->covariance_m2 ? 3 : 0;
    for (int i = 0; fix->covariance_m2 && i < 9; ++i) {
      m.covariance_m2[static_cast<std::size_t>(i)] = (*fix->covariance_m2)(i / 3, i % 3);
    }
    writer_->write(channel(fix->source.topic, "sensor_msgs/NavSatFix"), nanoseconds(fix->source.stamp_s),
                   messages::encode(encoding_, m));
  } else if (const auto* odometry = std::get_if<OdometrySample>(&observation)) {
    messages::Odometry m;
    m.header = header_of(odometry->source.stamp_s, odometry->source.frame_id);
    m.child_frame_id = odometry->child_frame_id;
    m.pose = fields_of(odometry->T_frame_child);
    writer_->write(channel(odometry->source.topic, "nav_msgs/Odometry"), nanoseconds(odometry->source.stamp_s),
                   messages::encode(encoding_, m));
  }
}

}  // namespace loopmark::io::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_observations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "loopmark/messages/types.hpp"
#include "loopmark/messages/wire.hpp"

namespace loopmark::io::internal {
namespace {

using messages::Encoding;

Eigen::Vector3d vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

Eigen::Quaterniond quaternion_of(const std::array<double, 4>& xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

bool is_rotation(const Eigen::Quaterniond& q) { return std::abs(q.norm() - 1.0) < 0.01; }

Pose pose_of(const messages::PoseFields& fields) {
  Pose pose = Pose::Identity();
  const Eigen::Quaterniond q = quaternion_of(fields.orientation_xyzw);
  pose.linear() = is_rotation(q) ? q.normalized().toRotationMatrix() : Eigen::Matrix3d::Identity();
  pose.translation() = vector_of(fields.position);
  return pose;
}

ObservationSource source_of(const messages::Header& header, const recordings::Channel& channel, std::int64_t time_ns) {
  const std::int64_t stamp = header.stamp_ns() != 0 ? header.stamp_ns() : time_ns;
  return {1e-9 * static_cast<double>(stamp), channel.topic, header.frame_id};
}

Observation imu_of(recordings::Encoding encoding, std::string_view bytes, const recordings::Channel& channel,
                   std::int64_t time_ns) {
  const auto m = messages::decode<messages::Imu>(encoding, bytes);
  ImuSample sample{source_of(m.header, channel, time_ns), vector_of(m.angular_velocity),
                   vector_of(m.linear_acceleration), std::nullopt};
  const Eigen::Quaterniond q = quaternion_of(m.orientation_xyzw);
  if (m.orientation_covariance[0] >= 0.0 && is_rotation(q)) {
    sample.orientation = q.normalized();
  }
  return sample;
}

Observation gnss_of(recordings::Encoding encoding, std::string_view bytes, const recordings::Channel& channel,
                    std::int64_t time_ns) {
  const auto m = messages::decode<messages::NavSatFix>(encoding, bytes);
  GnssFix fix{
      source_of(m.header, channel, time_ns), m.latitude_deg, m.longitude_deg, m.altitude_m, m.status, std::nullopt};
  if (m.covariance_type != 0) {
    fix.covariance_m2 = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.covariance_m2.data());
  }
  return fix;
}

Observation odometry_of(recordings::Encoding encoding, std::string_view bytes, const recordings::Channel& channel,
                        std::int64_t time_ns) {
  const auto m = messages::decode<messages::Odometry>(encoding, bytes);
  return OdometrySample{source_of(m.header, channel, time_ns), m.child_frame_id, pose_of(m.pose)};
}

Observation pose_stamped_of(recordings::Encoding encoding, std::string_view bytes, const recordings::Channel& channel,
                            std::int64_t time_ns) {
  const auto m = messages::decode<messages::PoseStamped>(encoding, bytes);
  return OdometrySample{source_of(m.header, channel, time_ns), "", pose_of(m.pose)};
}

using Decode = Observation (*)(recordings::Encoding, std::string_view, const recordings::Channel&, std::int64_t);

Decode decoder_of(const recordings::Channel& channel) {
  static const std::map<std::string, Decode, std::less<>> table = {{"sensor_msgs/Imu", imu_of},
                                                                   {"sensor_msgs/NavSatFix", gnss_of},
                                                                   {"nav_msgs/Odometry", odometry_of},
                                                                   {"geometry_msgs/PoseStamped", pose_stamped_of}};
  const auto found = table.find(channel.type);
  return found == table.end() || channel.encoding == recordings::Encoding::kOther ? nullptr : found->second;
}

std::string without_slash(const std::string& frame) { return frame.starts_with('/') ? frame.substr(1) : frame; }

/// T_parent_child of every static transform; the last word counts.
using Edges = std::map<std::pair<std::string, std::string>, Pose>;

Edges static_transforms(const RecordingIndex& index) {
  constexpr std::size_t kMostEdges = 10000;
  Edges edges;
  for (const KeptMessage& message : index.kept) {
    const recordings::Channel& channel = index.topics[message.channel].channel;
    if (!is_static_transform(channel) || edges.size() > kMostEdges) {
      continue;
    }
    try {
      for (const auto& t : messages::decode<messages::TransformMessage>(channel.encoding, message.bytes).transforms) {
        edges[{without_slash(t.header.frame_id), without_slash(t.child_frame_id)}] = pose_of(t.transform);
      }
    } catch (const InputError&) {
      continue;  // one transform less; what needed it says that it is missing
    }
  }
  return edges;
}

}  // namespace

bool is_static_transform(const recordings::Channel& channel) {
  return (channel.type == "tf2_msgs/TFMessage" || channel.type == "tf/tfMessage") &&
         channel.topic.find("tf_static") != std::string::npos;
}

std::optional<Observation> observation_of(const recordings::Channel& channel, std::int64_t time_ns,
                                          std::string_view bytes) {
  const Decode decode = decoder_of(channel);
  if (decode == nullptr) {
    return std::nullopt;
  }
  try {
    return decode(channel.encoding, bytes, channel, time_ns);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void visit_recording(recordings::Recording& recording, const ObservationVisitor& visit) {
  const auto wanted = [](const recordings::Channel& c) { return decoder_of(c) != nullptr ? recordings::kAllBytes : 0; };
  recording.walk(wanted, [&](const recordings::MessageRef& message, std::string_view bytes) {
    if (const auto seen = observation_of(recording.channels()[message.channel], message.time_ns, bytes)) {
      visit(*seen);
    }
  });
}

std::map<std::string, Pose> mounts_of(const RecordingIndex& index, const std::string& base) {
  std::map<std::string, Pose> known;
  const Edges edges = static_transforms(index);
  if (edges.empty() || base.empty()) {
    return known;
  }
  known[without_slash(base)] = Pose::Identity();
  for (bool grown = true; grown;) {
    grown = false;
    for (const auto& [ends, T_parent_child] : edges) {
      const auto parent = known.find(ends.first);
      const auto child = known.find(ends.second);
      if (parent != known.end() && child == known.end()) {
        known[ends.second] = parent->second * T_parent_child;
        grown = true;
      } else if (parent == known.end() && child != known.end()) {
        known[ends.first] = child->second * T_parent_child.inverse();
        grown = true;
      }
    }
  }
  return known;
}

}  // namespace loopmark::io::internal

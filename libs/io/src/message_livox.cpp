// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// livox_ros_driver/CustomMsg: points with the time of each since a timebase.
#include "cloud_message.hpp"
#include "loopmark/messages/types.hpp"
#include "point_columns.hpp"

namespace loopmark::io::internal {
namespace {

class LivoxDecoder : public CloudDecoder {
 public:
  LivoxDecoder(const MessageSamples& samples, const LogOptions& options)
      : encoding_(samples.channel.encoding), options_(options) {
    if (!samples.messages.empty()) {
      frame_id_ = messages::decode<messages::Header>(encoding_, samples.messages.front()).frame_id;
    }
  }

  PointFile decode(std::string_view message) const override {
    const auto m = messages::decode<messages::LivoxScan>(encoding_, message);
    PointFile file;
    PointCloud cloud;
    for (const messages::LivoxPoint& p : m.points) {
      cloud.points.emplace_back(p.x, p.y, p.z);
      cloud.intensity.push_back(static_cast<float>(p.reflectivity));
      cloud.ring.push_back(p.line);
      cloud.time_offset_s.push_back(static_cast<float>(1e-9 * p.offset_ns));
    }
    file.cloud = filter_invalid(std::move(cloud), options_, file.dropped);
    file.first_time_s = 1e-9 * static_cast<double>(m.timebase_ns);
    return file;
  }

  std::string describe() const override {
    return "points with reflectivity, line and time (nanoseconds from timebase)";
  }
  std::string frame_id() const override { return frame_id_; }

 private:
  messages::Encoding encoding_;
  LogOptions options_;
  std::string frame_id_;
};

}  // namespace

CloudMessage message_livox() {
  return {"livox_ros_driver/CustomMsg", 2, [](const MessageSamples& samples, const LogOptions& options) {
            return std::make_unique<LivoxDecoder>(samples, options);
          }};
}

}  // namespace loopmark::io::internal

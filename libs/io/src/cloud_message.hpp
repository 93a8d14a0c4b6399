// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The messages that hold a cloud, each with its decoder. A new one is one source, message_*.cpp, that defines a
/// function of its own name; the build lists them (see CMakeLists.txt).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "loopmark/io/point_files.hpp"
#include "loopmark/messages/wire.hpp"

namespace loopmark::io::internal {

/// Turns the messages of one topic into clouds, by what it learned from some of them.
class CloudDecoder {
 public:
  virtual ~CloudDecoder() = default;
  /// The cloud of a message, PointFile::first_time_s as for files. Throws InputError.
  virtual PointFile decode(std::string_view message) const = 0;
  /// What it found out: "x y z intensity ring t; t: nanoseconds from the stamp".
  virtual std::string describe() const = 0;
  /// The header's frame_id.
  virtual std::string frame_id() const = 0;
};

/// Some messages of a topic, from its beginning, middle and end.
struct MessageSamples {
  recordings::Channel channel;
  std::filesystem::path file;  ///< of the recording; calibrations may lie beside it
  std::vector<std::string> messages;
};

struct CloudMessage {
  std::string type;  ///< "sensor_msgs/PointCloud2"
  int worth = 0;     ///< of two topics of the same sensor the one worth more is taken: clouds before packets
  /// Throws InputError when the samples cannot be understood.
  std::function<std::unique_ptr<CloudDecoder>(const MessageSamples&, const LogOptions&)> learn;
};

/// All that are known; made by the build from the sources message_*.cpp.
const std::vector<CloudMessage>& cloud_messages();

/// The one of this type, or nullptr.
const CloudMessage* find_cloud_message(const std::string& type);

}  // namespace loopmark::io::internal

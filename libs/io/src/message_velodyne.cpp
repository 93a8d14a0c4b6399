// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_message.hpp"

namespace loopmark::io::internal {

CloudMessage message_velodyne() {
  return {"velodyne_msgs/VelodyneScan", 1, [](const MessageSamples& samples, const LogOptions& options) {
            return std::make_unique<PacketMessageDecoder<messages::VelodyneScan>>(samples, options, ".yaml");
          }};
}

}  // namespace loopmark::io::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_message.hpp"

namespace loopmark::io::internal {

CloudMessage message_pandar() {
  return {"pandar_msgs/PandarScan", 1, [](const MessageSamples& samples, const LogOptions& options) {
            return std::make_unique<PacketMessageDecoder<messages::PandarScan>>(samples, options, ".csv");
          }};
}

}  // namespace loopmark::io::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/packets/packet_decoder.hpp"

#include "hesai.hpp"
#include "velodyne.hpp"

namespace loopmark::packets {

std::unique_ptr<PacketDecoder> make_decoder(std::string_view packet, const std::filesystem::path& calibration) {
  if (auto decoder = internal::make_velodyne(packet, calibration)) {
    return decoder;
  }
  return internal::make_hesai(packet, calibration);
}

}  // namespace loopmark::packets

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// From frames of a network to UDP datagrams.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "loopmark/recordings/packet_capture.hpp"

namespace loopmark::recordings::internal {

/// Networks by the numbers that capture files give them (LINKTYPE_*).
bool is_known_link(std::uint32_t link);

class UdpReader {
 public:
  /// The datagram that this frame ends; nothing for other traffic and for fragments before the last. The bytes live
  /// until the next call.
  std::optional<Datagram> take(std::uint32_t link, std::string_view frame, std::int64_t time_ns, std::uint64_t place);

 private:
  struct Pending {
    std::string key;  ///< addresses, identification, protocol
    std::string bytes;
    std::size_t received = 0, whole = 0;  ///< whole: 0 until the last fragment was seen
    std::uint64_t place = 0;
  };
  std::optional<Datagram> take_ipv4(std::string_view packet, Datagram datagram);
  std::optional<Datagram> take_fragment(std::string_view packet, std::string_view content, Datagram datagram);

  std::deque<Pending> pending_;
  std::string whole_;
};

}  // namespace loopmark::recordings::internal

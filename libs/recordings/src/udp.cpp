// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "udp.hpp"

#include <algorithm>

namespace loopmark::recordings::internal {
namespace {

constexpr std::size_t kMostPending = 64;      // datagrams whose fragments have not all come
constexpr std::size_t kMostDatagram = 65535;  // bytes, of IPv4
constexpr std::uint32_t kNull = 0, kEthernet = 1, kRaw = 101, kLinuxCooked = 113, kIpv4 = 228, kIpv6 = 229,
                        kLinuxCooked2 = 276;

std::uint16_t big16(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[at]) << 8U |
                                    static_cast<unsigned char>(bytes[at + 1]));
}

std::uint32_t big32(std::string_view bytes, std::size_t at) {
  return std::uint32_t{big16(bytes, at)} << 16U | big16(bytes, at + 2);
}

std::string_view behind(std::string_view bytes, std::size_t count) {
  return bytes.size() < count ? std::string_view{} : bytes.substr(count);
}

/// The IP packet of an Ethernet frame, VLAN tags passed over.
std::string_view ip_of_ethernet(std::string_view frame) {
  std::size_t at = 12;
  while (frame.size() >= at + 2) {
    const std::uint16_t type = big16(frame, at);
    if (type == 0x8100 || type == 0x88A8 || type == 0x9100) {
      at += 4;
      continue;
    }
    return type == 0x0800 || type == 0x86DD ? frame.substr(at + 2) : std::string_view{};
  }
  return {};
}

std::string_view ip_of(std::uint32_t link, std::string_view frame) {
  switch (link) {
    case kEthernet:
      return ip_of_ethernet(frame);
    case kLinuxCooked:
      return behind(frame, 16);
    case kLinuxCooked2:
      return behind(frame, 20);
    case kNull:
      return behind(frame, 4);
    default:
      return frame;
  }
}

/// Ports and content of a UDP segment.
std::optional<Datagram> udp_of(std::string_view segment, Datagram datagram) {
  if (segment.size() < 8 || big16(segment, 4) < 8 || big16(segment, 4) > segment.size()) {
    return std::nullopt;
  }
  datagram.port = big16(segment, 2);
  datagram.bytes = segment.substr(8, big16(segment, 4) - 8U);
  return datagram;
}

}  // namespace

bool is_known_link(std::uint32_t link) {
  for (const std::uint32_t known : {kNull, kEthernet, kRaw, kLinuxCooked, kIpv4, kIpv6, kLinuxCooked2}) {
    if (link == known) {
      return true;
    }
  }
  return false;
}

std::optional<Datagram> UdpReader::take(std::uint32_t link, std::string_view frame, std::int64_t time_ns,
                                        std::uint64_t place) {
  const std::string_view packet = ip_of(link, frame);
  Datagram datagram{time_ns, place, 0, 0, {}};
  const int version = packet.empty() ? 0 : static_cast<unsigned char>(packet[0]) >> 4;
  if (version == 4) {
    return take_ipv4(packet, datagram);
  }
  if (version == 6 && packet.size() >= 40 && packet[6] == 17) {
    datagram.source = big32(packet, 20);
    return udp_of(packet.substr(40), datagram);
  }
  return std::nullopt;
}

std::optional<Datagram> UdpReader::take_ipv4(std::string_view packet, Datagram datagram) {
  const std::size_t head = 4U * (static_cast<unsigned char>(packet[0]) & 15U);
  if (head < 20 || packet.size() < head || packet[9] != 17) {
    return std::nullopt;
  }
  const std::size_t total = big16(packet, 2);
  if (total < head) {
    return std::nullopt;
  }
  datagram.source = big32(packet, 12);
  const std::string_view content = packet.substr(head, total - head);  // Ethernet pads short frames
  const std::uint16_t fragment = big16(packet, 6);
  return (fragment & 0x3FFFU) == 0 ? udp_of(content, datagram) : take_fragment(packet, content, datagram);
}

std::optional<Datagram> UdpReader::take_fragment(std::string_view packet, std::string_view content, Datagram datagram) {
  const std::string key = std::string(packet.substr(12, 8)) + std::string(packet.substr(4, 2));
  const std::uint16_t field = big16(packet, 6);
  const std::size_t offset = 8U * (field & 0x1FFFU);
  if (offset + content.size() > kMostDatagram) {
    return std::nullopt;
  }
  auto it = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& p) { return p.key == key; });
  if (it == pending_.end()) {
    if (pending_.size() >= kMostPending) {
      pending_.pop_front();
    }
    pending_.push_back({key, "", 0, 0, datagram.place});
    it = std::prev(pending_.end());
  }
  it->bytes.resize(std::max(it->bytes.size(), offset + content.size()));
  content.copy(it->bytes.data() + offset, content.size());
  it->received += content.size();
  if ((field & 0x2000U) == 0) {
    it->whole = offset + content.size();
  }
  if (it->whole == 0 || it->received < it->whole) {
    return std::nullopt;
  }
  whole_ = std::move(it->bytes);
  datagram.place = it->place;
  pending_.erase(it);
  return udp_of(whole_, datagram);
}

}  // namespace loopmark::recordings::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// pcap (a head, then records) and pcapng (blocks), of either byte order.
#include "loopmark/recordings/packet_capture.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "byte_source.hpp"
#include "loopmark/core/error.hpp"
#include "udp.hpp"

namespace loopmark::recordings {
namespace {

using internal::Window;

constexpr std::uint32_t kMicroseconds = 0xA1B2C3D4, kNanoseconds = 0xA1B23C4D;
constexpr std::uint32_t kSection = 0x0A0D0D0A, kByteOrder = 0x1A2B3C4D;
constexpr std::uint32_t kMostFrame = 1U << 20U;   // bytes; a frame has at most 64 kB
constexpr std::uint32_t kMostBlock = 16U << 20U;  // of pcapng: options and statistics too

std::uint32_t swapped(std::uint32_t v) { return __builtin_bswap32(v); }

struct Interface {
  std::uint32_t link = 0;
  double unit_ns = 1000.0;  ///< of its clock
};

}  // namespace

struct PacketCapture::State {
  explicit State(const std::filesystem::path& file) : source(file) {}

  std::uint32_t number32(std::string_view bytes, std::size_t at) const {
    const auto value = internal::number_at<std::uint32_t>(bytes, at);
    return swap ? swapped(value) : value;
  }
  std::uint16_t number16(std::string_view bytes, std::size_t at) const {
    const auto value = internal::number_at<std::uint16_t>(bytes, at);
    return swap ? __builtin_bswap16(value) : value;
  }
  std::string walk_pcap(std::uint64_t at, const std::function<bool(const Datagram&)>& visit) const;
  std::string walk_blocks(std::uint64_t at, const std::function<bool(const Datagram&)>& visit) const;
  void find_interfaces();
  void take_interface(std::string_view body);

  internal::ByteSource source;
  bool swap = false;
  bool blocks = false;  ///< pcapng
  std::vector<Interface> interfaces;
};

PacketCapture::PacketCapture(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {
  const std::string head = internal::first_bytes(file, 24);
  if (head.size() < 24) {
    throw InputError(file.string(), "byte 0", "the file ends before a capture's head");
  }
  const auto magic = internal::number_at<std::uint32_t>(head);
  if (magic == kSection) {
    state_->blocks = true;
    state_->swap = internal::number_at<std::uint32_t>(head, 8) != kByteOrder;
    state_->find_interfaces();
  } else if (is_packet_capture(file)) {
    state_->swap = magic != kMicroseconds && magic != kNanoseconds;
    const bool nanoseconds = magic == kNanoseconds || swapped(magic) == kNanoseconds;
    state_->interfaces.push_back({state_->number32(head, 20) & 0x0FFFFFFFU, nanoseconds ? 1.0 : 1000.0});
  } else {
    throw InputError(file.string(), "byte 0", "this is no packet capture");
  }
  for (const Interface& interface : state_->interfaces) {
    if (!internal::is_known_link(interface.link)) {
      throw InputError(file.string(), "",
                       "captured from a network of type " + std::to_string(interface.link) + ", which is not read",
                       "capture from Ethernet");
    }
  }
}

PacketCapture::~PacketCapture() = default;

std::string PacketCapture::walk(std::uint64_t from, const std::function<bool(const Datagram&)>& visit) const {
  return state_->blocks ? state_->walk_blocks(from, visit) : state_->walk_pcap(from == 0 ? 24 : from, visit);
}

std::string PacketCapture::State::walk_pcap(std::uint64_t at, const std::function<bool(const Datagram&)>& visit) const {
  constexpr std::size_t kRecord = 16;
  internal::UdpReader udp;
  Window window(source);
  while (at < source.size()) {
    const std::string_view head = window.at(at, kRecord);
    const std::string place = source.path().string() + ":byte " + std::to_string(at) + ": ";
    if (head.size() < kRecord) {
      return place + "the capture was cut off; what is whole is used";
    }
    const std::uint32_t length = number32(head, 8);
    const std::int64_t time_ns = std::int64_t{number32(head, 0)} * 1'000'000'000 +
                                 static_cast<std::int64_t>(interfaces[0].unit_ns * number32(head, 4));
    if (length > kMostFrame) {
      return place + "a frame of " + std::to_string(length) + " bytes: the file is damaged here; the rest is not read";
    }
    const std::string_view frame = window.at(at + kRecord, length);
    if (frame.size() < length) {
      return place + "the capture was cut off; what is whole is used";
    }
    const std::optional<Datagram> datagram = udp.take(interfaces[0].link, frame, time_ns, at);
    if (datagram && !visit(*datagram)) {
      return "";
    }
    at += kRecord + length;
  }
  return "";
}

void PacketCapture::State::take_interface(std::string_view body) {
  if (body.size() < 8 || interfaces.size() > 1000) {
    return;
  }
  Interface interface { number16(body, 0), 1000.0 };
  std::size_t at = 8;
  while (at + 4 <= body.size()) {  // options: code, length, value padded to four bytes
    const std::uint16_t code = number16(body, at), length = number16(body, at + 2);
    if (code == 0 || at + 4 + length > body.size()) {
      break;
    }
    if (code == 9 && length == 1) {  // the clock's unit: 10^-n s, or 2^-n s with the highest bit set
      const auto value = static_cast<unsigned char>(body[at + 4]);
      interface.unit_ns = 1e9 * ((value & 0x80U) != 0 ? std::pow(2.0, -(value & 0x7F)) : std::pow(10.0, -value));
    }
    at += 4U + (length + 3U) / 4U * 4U;
  }
  interfaces.push_back(interface);
}

/// Interfaces stand before the packets that were captured from them; of files joined to one another only the first
/// section is read.
void PacketCapture::State::find_interfaces() {
  Window window(source);
  std::uint64_t at = 0;
  while (true) {
    const std::string_view head = window.at(at, 8);
    const std::uint32_t length = head.size() < 8 ? 0 : number32(head, 4);
    const std::uint32_t type = head.size() < 8 ? 0 : number32(head, 0);
    if (length < 12 || length > kMostBlock || type == 6 || (type == kSection && at > 0)) {
      return;
    }
    if (type == 1) {
      take_interface(window.at(at + 8, length - 12));
    }
    at += length;
  }
}

std::string PacketCapture::State::walk_blocks(std::uint64_t at,
                                              const std::function<bool(const Datagram&)>& visit) const {
  internal::UdpReader udp;
  Window window(source);
  while (at < source.size()) {
    const std::string_view head = window.at(at, 8);
    const std::string place = source.path().string() + ":byte " + std::to_string(at) + ": ";
    const std::uint32_t length = head.size() < 8 ? 0 : number32(head, 4);
    const std::uint32_t type = head.size() < 8 ? 0 : number32(head, 0);
    if (head.size() == 8 && (length < 12 || length > kMostBlock || length % 4 != 0)) {
      return place + "a block of " + std::to_string(length) + " bytes: the file is damaged here; the rest is not read";
    }
    if (head.size() < 8 || at + length > source.size()) {
      return place + "the capture was cut off; what is whole is used";
    }
    if (type == kSection && at > 0) {
      return place + "a second section begins here; it is not read";
    }
    if (type == 6 && length >= 32) {  // an enhanced packet block
      const std::string_view body = window.at(at + 8, length - 12);
      const std::uint32_t interface = number32(body, 0), size = number32(body, 12);
      if (interface < interfaces.size() && size <= body.size() - 20) {
        const std::uint64_t ticks = std::uint64_t{number32(body, 4)} << 32U | number32(body, 8);
        const auto time_ns = static_cast<std::int64_t>(static_cast<long double>(ticks) * interfaces[interface].unit_ns);
        const auto datagram = udp.take(interfaces[interface].link, body.substr(20, size), time_ns, at);
        if (datagram && !visit(*datagram)) {
          return "";
        }
      }
    }
    at += length;
  }
  return "";
}

std::string Datagram::stream() const {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += std::to_string(source >> static_cast<unsigned>(shift) & 0xFFU) + (shift > 0 ? "." : ":");
  }
  return text + std::to_string(port);
}

bool is_packet_capture(const std::filesystem::path& file) {
  const std::string head = internal::first_bytes(file, 4);
  if (head.size() < 4) {
    return false;
  }
  const auto magic = internal::number_at<std::uint32_t>(head);
  for (const std::uint32_t known : {kMicroseconds, kNanoseconds, kSection}) {
    if (magic == known || swapped(magic) == known) {
      return true;
    }
  }
  return false;
}

}  // namespace loopmark::recordings

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// UDP datagrams of a packet capture (pcap and pcapng), as tcpdump and Wireshark write it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace loopmark::recordings {

struct Datagram {
  std::int64_t time_ns = 0;  ///< when it was captured, since 1970
  std::uint64_t place = 0;   ///< in the file, of its record; a walk can begin there
  std::uint32_t source = 0;  ///< IPv4 address; for IPv6 the last four bytes
  std::uint16_t port = 0;    ///< of its destination
  std::string_view bytes;

  /// "192.168.1.201:2368".
  std::string stream() const;
};

class PacketCapture {
 public:
  /// Throws InputError when it is no capture, or one of a network that is not read.
  explicit PacketCapture(const std::filesystem::path& file);
  ~PacketCapture();

  /// From the record at `from` (0: the first) on, until `visit` answers false. Thread-safe. Returns what is wrong with
  /// the file where it ended too early; empty when it did not. Fragments of IP are put together.
  std::string walk(std::uint64_t from, const std::function<bool(const Datagram&)>& visit) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

bool is_packet_capture(const std::filesystem::path& file);

}  // namespace loopmark::recordings

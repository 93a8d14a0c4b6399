// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/packets/packet_decoder.hpp"
#include "ouster_metadata.hpp"

namespace loopmark::packets::internal {

/// Where a profile keeps what of a pixel. Source: Ouster's firmware manual, "Lidar data packet format".
struct OusterProfile {
  const char* name = "";
  std::size_t pixel = 0;        ///< bytes
  std::size_t range_bytes = 4;  ///< of the word that holds the range
  std::uint32_t range_mask = 0;
  int range_shift = 0;        ///< to millimetres
  std::size_t intensity = 0;  ///< place of the signal, or the reflectivity where there is none
  std::size_t intensity_bytes = 2;
  std::size_t second = 0;  ///< place of the second return's range; 0: one return only
  std::size_t second_intensity = 0;
};

class OusterDecoder : public PacketDecoder {
 public:
  explicit OusterDecoder(OusterMetadata metadata);
  std::string sensor() const override { return "Ouster " + metadata_.product + " (" + profile_.name + ")"; }
  bool accepts(std::string_view bytes) const override { return bytes.size() == packet_bytes(); }
  std::size_t blocks(std::string_view) const override { return metadata_.columns_in_packet; }
  std::optional<std::size_t> cut(std::string_view bytes, CutState& state) const override;
  void decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const override;

  /// A column of pixels as the packet has it, for tests against other decoders.
  std::uint32_t range_mm(std::string_view bytes, std::size_t column, std::size_t row) const;
  std::size_t measurement(std::string_view bytes, std::size_t column) const;
  bool valid(std::string_view bytes, std::size_t column) const;

 private:
  bool legacy() const { return metadata_.profile == "LEGACY"; }
  std::size_t packet_head() const { return legacy() ? 0 : 32; }
  std::size_t column_head() const { return legacy() ? 16 : 12; }
  std::size_t column_bytes() const;
  std::size_t column_at(std::size_t column) const { return packet_head() + column * column_bytes(); }
  std::size_t packet_bytes() const { return column_at(metadata_.columns_in_packet) + packet_head(); }
  void add_return(SweepCloud& sweep, std::size_t row, std::size_t column, double range_m, double intensity,
                  double time_s) const;

  OusterMetadata metadata_;
  OusterProfile profile_;
};

}  // namespace loopmark::packets::internal

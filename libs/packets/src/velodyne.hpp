// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "loopmark/packets/packet_decoder.hpp"

namespace loopmark::packets::internal {

/// One laser's place in the sensor.
struct Laser {
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;   ///< added to the rotation, clockwise
  double distance_m = 0.0;    ///< added to the measured distance
  double vertical_m = 0.0;    ///< offset of the beam's origin along z
  double horizontal_m = 0.0;  ///< and across the beam
  std::uint16_t ring = 0;     ///< from below
};

/// What tells the models apart. Sources: the user manuals of VLP-16 (63-9243), HDL-32E (63-9113), VLP-32C (63-9325) and
/// HDL-64E S3 (63-HDL64ES3), section on the data packet.
struct VelodyneModel {
  const char* name = "";
  double distance_unit_m = 0.002;
  int firings_in_block = 1;     ///< VLP-16 fires its 16 lasers twice in a block of 32 returns
  double firing_cycle_s = 0.0;  ///< of all its lasers
  double laser_step_s = 0.0;    ///< between lasers, or groups of them, of a firing
  int lasers_at_once = 1;
  int banks = 1;  ///< blocks that hold one firing between them, told apart by their flags
  std::vector<Laser> lasers;
  std::size_t idle_after = 0;  ///< groups of lasers behind which one step passes without a shot; 0: none
};

class VelodyneDecoder : public PacketDecoder {
 public:
  explicit VelodyneDecoder(VelodyneModel model) : model_(std::move(model)) {}
  std::string sensor() const override { return std::string("Velodyne ") + model_.name; }
  bool accepts(std::string_view bytes) const override;
  std::size_t blocks(std::string_view) const override { return kBlocks; }
  std::optional<std::size_t> cut(std::string_view bytes, CutState& state) const override;
  void decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const override;

  static constexpr std::size_t kBytes = 1206;
  static constexpr std::size_t kBlocks = 12;

 private:
  bool dual(std::string_view bytes) const;
  double gap_deg(std::string_view bytes, std::size_t block) const;
  double laser_seconds(std::size_t laser) const;
  void decode_block(const Packet& packet, std::size_t block, SweepCloud& sweep) const;

  VelodyneModel model_;
};

/// The model that a packet's factory byte names; nothing for one that is not known. The calibration file replaces the
/// lasers' nominal places. Throws InputError for a model without nominal ones when there is no file.
std::unique_ptr<PacketDecoder> make_velodyne(std::string_view packet, const std::filesystem::path& calibration);

}  // namespace loopmark::packets::internal

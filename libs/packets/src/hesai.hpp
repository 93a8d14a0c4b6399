// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "velodyne.hpp"

namespace loopmark::packets::internal {

/// What tells the models apart: where things lie in a packet, and when the lasers fire. Sources: the user manuals of
/// Pandar40P, Pandar64, PandarQT, PandarXT, section on the point cloud data packet.
struct HesaiModel {
  const char* name = "";
  std::size_t header = 0;  ///< bytes before the first block
  std::size_t blocks = 0;
  std::size_t lasers = 0;
  std::size_t return_bytes = 3;  ///< distance uint16, reflectivity uint8, in some a confidence
  std::size_t tail_mode = 0;     ///< return mode, uint8, in the tail
  std::size_t tail_time = 0;     ///< microseconds, uint32, in the tail
  std::size_t tail = 0;          ///< least bytes behind the blocks
  double distance_unit_m = 0.004;
  double block_s = 0.0;       ///< between the firings of two blocks
  double laser_step_s = 0.0;  ///< between the lasers of a firing, where they follow each other evenly
  std::vector<Laser> beams;
  double least_range_m = 0.0;  ///< of its data sheet; nearer echoes come from the sensor itself
};

class HesaiDecoder : public PacketDecoder {
 public:
  explicit HesaiDecoder(HesaiModel model) : model_(std::move(model)) {}
  std::string sensor() const override { return std::string("Hesai ") + model_.name; }
  bool accepts(std::string_view bytes) const override;
  std::size_t blocks(std::string_view) const override { return model_.blocks; }
  std::optional<std::size_t> cut(std::string_view bytes, CutState& state) const override;
  void decode(const Packet& packet, std::size_t begin, std::size_t end, SweepCloud& sweep) const override;

 private:
  std::size_t block_bytes() const { return 2 + model_.lasers * model_.return_bytes; }
  std::size_t block_at(std::size_t block) const { return model_.header + block * block_bytes(); }
  std::size_t tail_at() const { return block_at(model_.blocks); }
  bool dual(std::string_view bytes) const;
  void decode_block(const Packet& packet, std::size_t block, SweepCloud& sweep) const;

  HesaiModel model_;
};

/// Throws InputError for a model without nominal angles when there is no calibration file.
std::unique_ptr<PacketDecoder> make_hesai(std::string_view packet, const std::filesystem::path& calibration);

}  // namespace loopmark::packets::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// All tiles of a map: those in use in memory, the others on the disk.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "scratch_file.hpp"
#include "tile.hpp"

namespace loopmark::occupancy {

class TileStore {
 public:
  /// `max_blocks`: blocks kept in memory between scans.
  TileStore(const std::filesystem::path& scratch, std::size_t max_blocks) : file_(scratch), max_blocks_(max_blocks) {}

  /// The tile at tile coordinates, read back or made when it is not in memory. Valid until trim().
  Tile& tile(const Eigen::Vector3i& at);

  /// Moves the tiles that were not used for longest to the disk until the rest fits. Call it between scans.
  void trim();

  /// Bytes (Tile::to_bytes) of each tile in tile_number order: visit(number, bytes).
  template <class Visit>
  void for_each(const Visit& visit) {
    for (auto& [number, entry] : entries_) {
      visit(number, entry.tile ? entry.tile->to_bytes() : file_.read(*entry.stored));
    }
  }

  std::size_t size() const { return entries_.size(); }
  std::size_t spilled() const { return spilled_; }

 private:
  struct Entry {
    std::unique_ptr<Tile> tile;
    std::optional<Extent> stored;
    std::uint64_t used = 0;  ///< scan that used it last
  };

  std::map<std::uint32_t, Entry> entries_;
  ScratchFile file_;
  std::size_t max_blocks_;
  std::uint64_t scan_ = 0;
  std::size_t spilled_ = 0;
};

}  // namespace loopmark::occupancy

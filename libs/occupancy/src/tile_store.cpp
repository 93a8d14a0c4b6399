// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "tile_store.hpp"

#include <algorithm>
#include <vector>

namespace loopmark::occupancy {

Tile& TileStore::tile(const Eigen::Vector3i& at) {
  Entry& entry = entries_[tile_number(at)];
  if (!entry.tile) {
    entry.tile = std::make_unique<Tile>(entry.stored ? Tile::from_bytes(file_.read(*entry.stored)) : Tile());
  }
  entry.used = scan_;
  return *entry.tile;
}

void TileStore::trim() {
  ++scan_;
  std::size_t blocks = 0;
  std::vector<std::pair<std::uint64_t, Entry*>> held;
  for (auto& [number, entry] : entries_) {
    if (entry.tile) {
      blocks += entry.tile->block_count();
      held.emplace_back(entry.used, &entry);
    }
  }
  if (blocks <= max_blocks_) {
    return;
  }
  std::stable_sort(held.begin(), held.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  // Down to three quarters, so that not every scan has to.
  for (auto& [used, entry] : held) {
    if (blocks <= max_blocks_ * 3 / 4) {
      break;
    }
    blocks -= entry->tile->block_count();
    entry->stored = file_.append(entry->tile->to_bytes());
    entry->tile.reset();
    ++spilled_;
  }
}

}  // namespace loopmark::occupancy

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A cube of 128 voxels: a subtree of seven levels, stored as dense blocks of eight voxels while it is worked on.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "voxel_key.hpp"

namespace loopmark::occupancy::internal {

constexpr int kTileLevels = 7;
constexpr int kTileVoxels = 1 << kTileLevels;
constexpr int kBlockLevels = 3;
constexpr int kBlockVoxels = 1 << kBlockLevels;
constexpr int kTileBlocks = kTileVoxels / kBlockVoxels;

/// Log-odds of 8 x 8 x 8 voxels, x fastest; NaN: unknown.
using Block = std::array<float, kBlockVoxels * kBlockVoxels * kBlockVoxels>;

class Tile {
 public:
  /// The block at block coordinates in [0, 16), made when it is not there. References stay valid.
  Block& block(int x, int y, int z);
  std::size_t weight() const { return blocks_.size(); }  ///< blocks

  /// The pruned subtree in preorder, as OctoMap's .ot stores it: a float and the mask of children for each node.
  std::string to_bytes() const;
  static Tile from_bytes(const std::string& bytes);

 private:
  friend class TileReader;
  friend class TileSerializer;
  static constexpr std::uint16_t kNone = 0xffff;

  std::vector<std::uint16_t> place_ = std::vector<std::uint16_t>(kTileBlocks * kTileBlocks * kTileBlocks, kNone);
  std::deque<Block> blocks_;
};

/// The tile's number in the order in which a preorder walk of the whole tree meets it: bits of its coordinates (in
/// tiles) interleaved, x lowest.
std::uint32_t tile_number(const Eigen::Vector3i& tile);

}  // namespace loopmark::occupancy::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "tile.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace loopmark::occupancy::internal {
namespace {

constexpr std::size_t kRecord = 5;  // a float and a byte

std::size_t block_index(int x, int y, int z) {
  return static_cast<std::size_t>((z * kTileBlocks + y) * kTileBlocks + x);
}

std::size_t voxel_index(int x, int y, int z) {
  return static_cast<std::size_t>((z * kBlockVoxels + y) * kBlockVoxels + x);
}

}  // namespace

Block& Tile::block(int x, int y, int z) {
  std::uint16_t& place = place_[block_index(x, y, z)];
  if (place == kNone) {
    place = static_cast<std::uint16_t>(blocks_.size());
    blocks_.emplace_back().fill(std::numeric_limits<float>::quiet_NaN());
  }
  return blocks_[place];
}

/// Writes subtrees bottom up: a node's record is reserved before its children and filled in after them.
class TileSerializer {
 public:
  explicit TileSerializer(const Tile& tile) : tile_(tile) {}

  std::string run() {
    node(0, 0, 0, kTileLevels);
    return std::move(bytes_);
  }

 private:
  struct Summary {
    bool known = false;
    bool leaf = false;
    float value = 0.0F;
  };

  /// The subtree whose corner is at the voxel (x, y, z) of the tile.
  Summary node(int x, int y, int z, int levels) {
    if (levels == 0) {
      return voxel(x, y, z);
    }
    if (levels == kBlockLevels &&
        tile_.place_[block_index(x / kBlockVoxels, y / kBlockVoxels, z / kBlockVoxels)] == Tile::kNone) {
      return {};
    }
    return inner(x, y, z, levels);
  }

  Summary inner(int x, int y, int z, int levels) {
    const std::size_t start = bytes_.size();
    bytes_.append(kRecord, '\0');
    const int half = 1 << (levels - 1);
    unsigned mask = 0;
    bool alike = true;
    float most = -std::numeric_limits<float>::infinity();
    for (int child = 0; child < 8; ++child) {
      const Summary s =
          node(x + half * (child & 1), y + half * (child >> 1 & 1), z + half * (child >> 2 & 1), levels - 1);
      alike = alike && s.known && s.leaf && (child == 0 || s.value == most);
      if (s.known) {
        mask |= 1U << child;
        most = std::max(most, s.value);
      }
    }
    if (mask == 0 || alike) {
      bytes_.resize(start);
      return mask == 0 ? Summary{} : leaf(most);
    }
    put(start, most, mask);
    return {true, false, most};
  }

  Summary voxel(int x, int y, int z) {
    const Block& block = tile_.blocks_[tile_.place_[block_index(x / kBlockVoxels, y / kBlockVoxels, z / kBlockVoxels)]];
    const float value = block[voxel_index(x % kBlockVoxels, y % kBlockVoxels, z % kBlockVoxels)];
    return std::isnan(value) ? Summary{} : leaf(value);
  }

  Summary leaf(float value) {
    bytes_.append(kRecord, '\0');
    put(bytes_.size() - kRecord, value, 0);
    return {true, true, value};
  }

  void put(std::size_t at, float value, unsigned mask) {
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    bytes_[at + sizeof value] = static_cast<char>(mask);
  }

  const Tile& tile_;
  std::string bytes_;
};

std::string Tile::to_bytes() const { return TileSerializer(*this).run(); }

/// The way back: fills blocks from the records.
class TileReader {
 public:
  TileReader(const std::string& bytes, Tile& tile) : bytes_(bytes), tile_(tile) {}

  void node(int x, int y, int z, int levels) {
    if (at_ + kRecord > bytes_.size()) {
      throw std::runtime_error("a tile of the occupancy map is damaged");
    }
    float value = 0.0F;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    const auto mask = static_cast<unsigned char>(bytes_[at_ + sizeof value]);
    at_ += kRecord;
    if (mask == 0) {
      fill(x, y, z, 1 << levels, value);
      return;
    }
    const int half = 1 << (levels - 1);
    for (int child = 0; child < 8; ++child) {
      if ((mask >> child & 1U) != 0) {
        node(x + half * (child & 1), y + half * (child >> 1 & 1), z + half * (child >> 2 & 1), levels - 1);
      }
    }
  }

 private:
  void fill(int x0, int y0, int z0, int edge, float value) {
    for (int z = z0; z < z0 + edge; ++z) {
      for (int y = y0; y < y0 + edge; ++y) {
        for (int x = x0; x < x0 + edge; ++x) {
          tile_.block(x / kBlockVoxels, y / kBlockVoxels,
                      z / kBlockVoxels)[voxel_index(x % kBlockVoxels, y % kBlockVoxels, z % kBlockVoxels)] = value;
        }
      }
    }
  }

  const std::string& bytes_;
  Tile& tile_;
  std::size_t at_ = 0;
};

Tile Tile::from_bytes(const std::string& bytes) {
  Tile tile;
  if (!bytes.empty()) {
    TileReader(bytes, tile).node(0, 0, 0, kTileLevels);
  }
  return tile;
}

std::uint32_t tile_number(const Eigen::Vector3i& tile) {
  std::uint32_t number = 0;
  for (int bit = 0; bit < kTreeDepth - kTileLevels; ++bit) {
    for (int axis = 0; axis < 3; ++axis) {
      number |= static_cast<std::uint32_t>(tile[axis] >> bit & 1) << (3 * bit + axis);
    }
  }
  return number;
}

}  // namespace loopmark::occupancy::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "apply_scan.hpp"

#include <bit>
#include <vector>

#include "loopmark/core/parallel.hpp"

namespace loopmark::occupancy::internal {
namespace {

/// A block that the scan touches, and the byte of its first row in the bit volumes.
struct Touched {
  Block* block = nullptr;
  std::int64_t first_byte = 0;
};

/// The byte of row (y, z) of a block: eight voxels along x.
std::int64_t row_byte(const Box& box, const Touched& touched, int y, int z) {
  return touched.first_byte + (y * box.stride_y() + z * box.stride_z()) / 8;
}

unsigned byte_of(const Words& words, std::int64_t byte) {
  return static_cast<unsigned>(words[static_cast<std::size_t>(byte / 8)] >> (8 * (byte % 8)) & 255U);
}

/// For the eight blocks along x whose first rows share a word: which of them the scan touches, as bytes.
std::uint64_t union_of_rows(const ScanVoxels& voxels, std::int64_t first_word) {
  std::uint64_t all = 0;
  for (int z = 0; z < kBlockVoxels; ++z) {
    for (int y = 0; y < kBlockVoxels; ++y) {
      const auto word =
          static_cast<std::size_t>(first_word + (y * voxels.box.stride_y() + z * voxels.box.stride_z()) / 64);
      all |= voxels.passed[word] | voxels.hit[word];
    }
  }
  return all;
}

/// Finds the touched blocks and makes those that are not there yet; on one thread, since it changes the store.
std::vector<Touched> touched_blocks(const ScanVoxels& voxels, TileStore& store) {
  const Box& box = voxels.box;
  std::vector<Touched> touched;
  Tile* held = nullptr;
  Eigen::Vector3i held_at(-1, -1, -1);
  for (int z = 0; z < box.size.z(); z += kBlockVoxels) {
    for (int y = 0; y < box.size.y(); y += kBlockVoxels) {
      for (int x = 0; x < box.size.x(); x += 64) {
        const std::int64_t place = x + y * box.stride_y() + z * box.stride_z();
        const std::uint64_t rows = union_of_rows(voxels, place / 64);
        for (int b = 0; b < 8; ++b) {
          if ((rows >> (8 * b) & 255U) == 0) {
            continue;
          }
          const Key key = box.corner + Eigen::Vector3i(x + 8 * b, y, z);
          const Eigen::Vector3i at = key / kTileVoxels;
          if (held == nullptr || at != held_at) {
            held = &store.at(tile_number(at));
            held_at = at;
          }
          const Eigen::Vector3i in = (key - at * kTileVoxels) / kBlockVoxels;
          touched.push_back({&held->block(in.x(), in.y(), in.z()), place / 8 + b});
        }
      }
    }
  }
  return touched;
}

void update_block(const ScanVoxels& voxels, const LogOdds& odds, const Touched& touched) {
  for (int z = 0; z < kBlockVoxels; ++z) {
    for (int y = 0; y < kBlockVoxels; ++y) {
      const std::int64_t byte = row_byte(voxels.box, touched, y, z);
      const unsigned hit = byte_of(voxels.hit, byte);
      float* row = touched.block->data() + (z * kBlockVoxels + y) * kBlockVoxels;
      for (unsigned any = hit | byte_of(voxels.passed, byte); any != 0; any &= any - 1) {
        const int x = std::countr_zero(any);
        row[x] = odds.updated(row[x], (hit >> x & 1U) != 0 ? odds.hit : odds.miss);
      }
    }
  }
}

}  // namespace

void apply_scan(const ScanVoxels& voxels, const LogOdds& odds, TileStore& store) {
  const std::vector<Touched> touched = touched_blocks(voxels, store);
  parallel_for(
      touched.size(), [&](std::size_t i) { update_block(voxels, odds, touched[i]); }, 256);
}

}  // namespace loopmark::occupancy::internal

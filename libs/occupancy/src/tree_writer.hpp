// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Puts subtrees of tiles together to a whole tree file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/storage/scratch_file.hpp"

namespace loopmark::occupancy::internal {

/// The two formats of OctoMap: .ot with log-odds, .bt with free and occupied only.
enum class TreeFormat { kFull, kBinary };

/// A tile's subtree as the format stores it, and what its parent has to know of it.
struct Subtree {
  std::string bytes;
  bool leaf = false;
  float value = 0.0F;  ///< log-odds (greatest of its leaves); binary: 1 occupied, 0 free
  std::size_t nodes = 0;
};

/// From the bytes of Tile::to_bytes. The binary one holds maximum-likelihood states (log-odds >= 0: occupied), pruned
/// again: nothing for a leaf, whose state stands in its parent, and two bits a child for inner nodes.
Subtree full_subtree(const std::string& tile_bytes);
Subtree binary_subtree(const std::string& tile_bytes);

/// Collects the subtrees of a map in tile_number order, then writes the file.
class TreeWriter {
 public:
  TreeWriter(TreeFormat format, double resolution_m, const std::filesystem::path& scratch);

  void add(std::uint32_t tile_number, const Subtree& subtree);

  /// Writes the file whole or not at all; returns the number of nodes.
  std::size_t write(const std::filesystem::path& path);

 private:
  static constexpr std::int32_t kNone = -1;
  struct Node {
    std::array<std::int32_t, 8> children{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
    storage::Extent extent;  ///< of a tile
    bool is_tile = false;
    bool leaf = false;
    float value = 0.0F;
    std::size_t nodes = 0;
  };

  void summarize(std::int32_t at);
  void write_node(std::ostream& out, std::int32_t at);
  unsigned child_mask(const Node& node) const;
  unsigned binary_mask(const Node& node) const;

  TreeFormat format_;
  double resolution_m_;
  storage::ScratchFile file_;
  std::vector<Node> nodes_;
};

}  // namespace loopmark::occupancy::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Numbers the occupied voxels of a point set in the order in which they are first seen.
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/search/voxel.hpp"

namespace loopmark::search {

/// Open-addressing table from voxel to a running number: 0 for the first voxel seen, 1 for the next.
class VoxelTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  explicit VoxelTable(std::size_t expected) {
    std::size_t capacity = 64;
    while (capacity < 2 * expected) {
      capacity *= 2;
    }
    slots_.assign(capacity, kNone);
    voxels_.reserve(expected);
  }

  /// The voxel's number; a new voxel gets the next one.
  std::uint32_t insert(const Voxel& voxel) {
    if (2 * (voxels_.size() + 1) > slots_.size()) {
      grow();
    }
    const std::size_t slot = find_slot(voxel);
    if (slots_[slot] == kNone) {
      slots_[slot] = static_cast<std::uint32_t>(voxels_.size());
      voxels_.push_back(voxel);
    }
    return slots_[slot];
  }

  /// The voxel's number, or kNone.
  std::uint32_t find(const Voxel& voxel) const { return slots_[find_slot(voxel)]; }

  std::size_t size() const { return voxels_.size(); }
  const std::vector<Voxel>& voxels() const { return voxels_; }

 private:
  std::size_t find_slot(const Voxel& voxel) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>(voxel_hash(voxel)) & mask;
    while (slots_[slot] != kNone && !(voxels_[slots_[slot]] == voxel)) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kNone);
    for (std::uint32_t i = 0; i < voxels_.size(); ++i) {
      slots_[find_slot(voxels_[i])] = i;
    }
  }

  std::vector<std::uint32_t> slots_;
  std::vector<Voxel> voxels_;
};

}  // namespace loopmark::search

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "voxel_key.hpp"

namespace loopmark::occupancy::internal {

/// A box of voxels, its corner at a multiple of eight voxels, its size along x a multiple of 64, along y and z of
/// eight.
struct Box {
  Key corner = Key::Zero();
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  std::int64_t words() const { return static_cast<std::int64_t>(size.x()) / 64 * size.y() * size.z(); }
  std::int64_t stride_y() const { return size.x(); }
  std::int64_t stride_z() const { return static_cast<std::int64_t>(size.x()) * size.y(); }
  /// Bit of a voxel.
  std::int64_t place(const Key& key) const {
    const Eigen::Vector3i d = key - corner;
    return d.x() + d.y() * stride_y() + d.z() * stride_z();
  }

  /// Around both corners, with room for a step too far.
  static Box around(const Key& low, const Key& high) {
    Box box;
    box.corner = (low.array() - 2).unaryExpr([](int k) { return k - (k & 7); });
    const Eigen::Vector3i span = high.array() + 3 - box.corner.array();
    box.size = Eigen::Vector3i((span.x() + 63) / 64 * 64, (span.y() + 7) / 8 * 8, (span.z() + 7) / 8 * 8);
    return box;
  }
};

using Words = std::vector<std::uint64_t>;

inline void set_bit(std::uint64_t* words, std::int64_t place) { words[place >> 6] |= std::uint64_t{1} << (place & 63); }

}  // namespace loopmark::occupancy::internal

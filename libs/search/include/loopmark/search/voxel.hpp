// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Integer voxel coordinates and their hash.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace loopmark::search {

/// A cell of a regular grid, by its integer coordinates.
struct Voxel {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  bool operator==(const Voxel&) const = default;
};

/// The voxel that holds a point; `inverse_size` is 1 / edge (1 / metres).
inline Voxel voxel_of(const Eigen::Vector3f& point, float inverse_size) {
  return {static_cast<std::int32_t>(std::floor(point.x() * inverse_size)),
          static_cast<std::int32_t>(std::floor(point.y() * inverse_size)),
          static_cast<std::int32_t>(std::floor(point.z() * inverse_size))};
}

/// Mixes the coordinates to 64 well spread bits.
inline std::uint64_t voxel_hash(const Voxel& v) {
  std::uint64_t h = static_cast<std::uint32_t>(v.x) * 0x9e3779b97f4a7c15ULL;
  h = (h ^ static_cast<std::uint32_t>(v.y)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 29U) ^ static_cast<std::uint32_t>(v.z)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 32U);
}

/// For std::unordered_map and std::unordered_set.
struct VoxelHash {
  std::size_t operator()(const Voxel& v) const { return static_cast<std::size_t>(voxel_hash(v)); }
};

}  // namespace loopmark::search

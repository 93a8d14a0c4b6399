// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Voxel indices as OctoMap counts them: 16 levels, 65536 voxels along each axis, the middle one at the origin.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace loopmark::occupancy::internal {

constexpr int kTreeDepth = 16;
constexpr int kMiddle = 1 << (kTreeDepth - 1);

using Key = Eigen::Vector3i;

inline int key_of(float coordinate, double inverse_resolution) {
  return static_cast<int>(std::floor(inverse_resolution * static_cast<double>(coordinate))) + kMiddle;
}

/// False when the point lies outside the tree.
inline bool key_of(const Eigen::Vector3f& point, double inverse_resolution, Key& key) {
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(inverse_resolution * static_cast<double>(point[i])) < kMiddle)) {
      return false;
    }
    key[i] = key_of(point[i], inverse_resolution);
  }
  return (key.array() >= 0).all() && (key.array() < 2 * kMiddle).all();
}

/// Centre of a voxel along one axis, metres.
inline double centre_of(int key, double resolution) { return (static_cast<double>(key - kMiddle) + 0.5) * resolution; }

}  // namespace loopmark::occupancy::internal

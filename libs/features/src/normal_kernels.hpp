// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace loopmark::features::internal {

/// Candidates come in multiples of this many; what fills up the last is far away.
constexpr std::size_t kLanes = 16;
constexpr float kFarAway = 1e15F;

/// Sums over the candidates within a radius of (qx, qy, qz), relative to it:
/// count, x, y, z, xx, xy, xz, yy, yz, zz.
using Moments = std::array<float, 10>;
Moments moments_within(const float* x, const float* y, const float* z, std::size_t count, float qx, float qy, float qz,
                       float squared_radius);

}  // namespace loopmark::features::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace loopmark::shape_context::internal {

constexpr std::size_t kSectors = 36;
constexpr std::size_t kRings = 10;

/// The place of points (dx, dy) in a polar grid, as real numbers. With p = kRings (d / radius)^(3/4), `ring` is
/// p + 1/2, so that ring r of the grid is centred at r + 1, at most kRings + 1/2; and inside the centre of the first
/// ring 2 p, which ends at 0 for d = 0. `sector` is in [0, kSectors); the arc tangent is good to 1e-4 radians.
void polar_places(const float* dx, const float* dy, std::size_t count, float radius, float* ring, float* sector);

}  // namespace loopmark::shape_context::internal

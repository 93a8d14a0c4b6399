// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace loopmark::estimation::internal {

/// Pairs are filled up to a multiple of this many with pairs that fit no motion.
constexpr std::size_t kPairLanes = 16;

/// Source x y z, target x y z, each of `count` floats.
struct PairArrays {
  std::array<const float*, 6> v{};
  std::size_t count = 0;
};

/// MSAC: sum of max(0, 1 - r^2 / t^2) under the motion m (3 x 4, row-major). Gives up, returning a number not above
/// `best`, as soon as `best` cannot be beaten.
float msac_score(const PairArrays& pairs, const float m[12], float inverse_squared, float best);

}  // namespace loopmark::estimation::internal

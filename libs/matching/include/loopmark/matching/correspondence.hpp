// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

namespace loopmark::matching {

/// A putative match: a source point and the target point nearest to it in feature space.
struct Correspondence {
  std::uint32_t source = 0;
  std::uint32_t target = 0;
  float distance = 0.0F;  ///< d1, distance in feature space
  float ratio = 1.0F;     ///< d1 / d2, lower is better (the reciprocal of S, paper eq. 1); 1 where there is no second
  bool mutual = false;    ///< the source point is in turn the nearest to the target point
};

using Correspondences = std::vector<Correspondence>;

/// Order of quality (paper, Sec. 4): mutual first, then the lower ratio; ties by source, then target, so that the
/// order is the same everywhere. PROSAC draws in this order.
inline bool better(const Correspondence& a, const Correspondence& b) {
  return std::make_tuple(!a.mutual, a.ratio, a.source, a.target) <
         std::make_tuple(!b.mutual, b.ratio, b.source, b.target);
}

}  // namespace loopmark::matching

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "loopmark/refinement/icp.hpp"

namespace loopmark::refinement::internal {

constexpr std::uint32_t kUnpaired = std::numeric_limits<std::uint32_t>::max();

/// Pairs of one iteration: for each source point its place in the target grid, or kUnpaired.
struct Pairs {
  std::vector<Eigen::Vector3f> moved;
  std::vector<std::uint32_t> place;
};

/// Moves the source and pairs it with the target. The pairs of the iteration before bound the search.
void find_pairs(const Surface& source, const IcpTarget& target, const Pose& T_target_source, const IcpOptions& options,
                Pairs& pairs);

/// Sums of the metric over the pairs, about `centre`, in a fixed order.
least_squares::PairEquations linearise(const Surface& source, const IcpTarget& target, const Pose& T_target_source,
                                       const Eigen::Vector3d& centre, IcpMetric metric, const IcpOptions& options,
                                       const Pairs& pairs);

}  // namespace loopmark::refinement::internal

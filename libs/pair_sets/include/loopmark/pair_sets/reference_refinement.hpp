// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Better reference motions for a set, from the scans themselves.
#pragma once

#include <vector>

#include "loopmark/pair_sets/candidate_pool.hpp"

namespace loopmark::pair_sets {

enum class ReferenceRefinement {
  kNone,
  kIcp,    ///< all six directions
  kHeight  ///< z only: for data sets whose poses have no usable height (nuScenes)
};

struct RefinementReport {
  std::size_t refined = 0;
  std::size_t kept = 0;  ///< ICP moved too far or found too little: the poses' motion stays
  double median_shift_m = 0.0;
};

/// Refines the motions of pairs by ICP (0.3 m clouds, pairs within 0.6 m) from the poses' motion. A motion that moves
/// by more than 1 m or 2 deg stays as it was. Overlaps are computed again.
RefinementReport refine_references(std::vector<RegistrationPair>& pairs, const std::vector<Drive>& drives,
                                   ReferenceRefinement how);

}  // namespace loopmark::pair_sets

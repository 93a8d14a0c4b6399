// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/matching/correspondence.hpp"
#include "loopmark/matching/nearest_two.hpp"

namespace loopmark::matching {

/// One correspondence for every source row that has a neighbour (paper, Sec. 4), in the order of the rows.
Correspondences correspondences_of(const TwoWayNearest& nearest);

/// Mutual nearest neighbours only.
Correspondences keep_mutual(const Correspondences& matches);

/// Only matches with d1 / d2 of at most `max_ratio` (Lowe's ratio test).
Correspondences keep_ratio(const Correspondences& matches, double max_ratio);

/// The `count` best, in the order of quality; 0: all.
Correspondences keep_best(Correspondences matches, std::size_t count);

/// Options of Grid-Prioritized Filtering, GPF(phi, M).
struct GpfOptions {
  double phi = 2.0;
  std::size_t cells = 10;
  std::size_t max_matches = 0;
};

template <class Visitor>
void describe(Visitor& v, GpfOptions& o) {
  v.field("phi", o.phi, "matches to keep, as a multiple of the number of mutual ones");
  v.field("cells", o.cells, "M: the grid has M x M cells");
  v.field("max_matches", o.max_matches, "never ask for more than this many; 0: no limit");
}

inline void check(const GpfOptions& o) {
  require_option(o.phi > 0, "phi", "must be larger than 0");
  require_option(o.cells > 0 && o.cells <= 1000, "cells", "must be from 1 to 1000");
}

/// The largest level l for which the sum over cells of min(count, l) is closest to `wanted` (paper, appendix "GPF",
/// solved exactly instead of by bisection).
std::size_t water_level(const std::vector<std::size_t>& counts, double wanted);

/// Grid-Prioritized Filtering (paper, Sec. 4 and appendix): an M x M grid in x and y over the matched source points,
/// from each cell its best matches up to a common number, about phi * |mutual| in all. Returned in the order of
/// quality. Throws std::invalid_argument when a match names a point that is not there.
Correspondences grid_prioritized_filter(const Correspondences& matches, const std::vector<Eigen::Vector3f>& source,
                                        const GpfOptions& options);

}  // namespace loopmark::matching

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Global planar alignment of two scans: whitened correlation of their structure over all yaws.
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/bev/structure.hpp"

namespace loopmark::bev {

struct CorrelationOptions {
  std::size_t side = 256;          ///< cells a side of the correlation grid, a power of two
  double cell_m = 0.6;             ///< edge of a cell
  double yaw_step_deg = 3.0;       ///< step of the yaw search
  double blur_m = 0.4;             ///< standard deviation of the smoothing
  double relief_weight = 1.0;      ///< of the relief of the ground beside structure
  std::size_t peaks = 100;         ///< distinct peaks that are returned
  double distinct_m = 2.0;         ///< peaks nearer than this and ...
  double distinct_deg = 5.0;       ///< ... turned by less than this are one
  double longest_shift_m = 105.0;  ///< along each axis; where it exceeds side * cell_m / 2 a peak may stand for several
};

template <class Visitor>
void describe(Visitor& v, CorrelationOptions& o) {
  v.field("side", o.side, "cells a side of the correlation grid, a power of two");
  v.field("cell_m", o.cell_m, "edge of a cell, metres");
  v.field("yaw_step_deg", o.yaw_step_deg, "step of the yaw search, degrees");
  v.field("blur_m", o.blur_m, "standard deviation of the smoothing, metres");
  v.field("relief_weight", o.relief_weight, "weight of the relief of the ground beside structure");
  v.field("peaks", o.peaks, "distinct peaks that are returned");
  v.field("distinct_m", o.distinct_m, "peaks nearer than this, metres, and ...");
  v.field("distinct_deg", o.distinct_deg, "... turned by less than this, degrees, are one");
  v.field(
      "longest_shift_m", o.longest_shift_m,
      "longest translation along each axis, metres; where it exceeds side * cell_m / 2 a peak may stand for several");
}

/// Source cells turned by yaw (radians) and moved by (x, y) fall onto target cells.
struct PlanarHypothesis {
  double yaw = 0.0;
  double x = 0.0;  ///< metres
  double y = 0.0;
  double score = 0.0;  ///< height of the peak in standard deviations of its surface
};

/// For every yaw: c = F^-1( sum over height bands of F(T) conj(F(S)) / |F(T) F(S)| ); the peaks of all surfaces,
/// distinct ones, highest first. The grid is periodic: a peak stands for every shift that differs by whole sides of the
/// grid and is no longer than asked; all of them are returned, the shortest first. Keeping only the phase keeps the
/// dense neighbourhood of either sensor from correlating with itself: the zero-motion alias. The same bytes at any
/// number of threads.
std::vector<PlanarHypothesis> correlate(const BirdseyeView& source, const BirdseyeView& target,
                                        const CorrelationOptions& options);

}  // namespace loopmark::bev

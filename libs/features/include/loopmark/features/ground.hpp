// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "loopmark/core/options.hpp"

namespace loopmark::features {

struct GroundOptions {
  double cell_m = 4.0;
  double clearance_m = 0.4;
  double flat_clearance_m = 1.0;
  double flat_cosine = 0.9;
};

template <class Visitor>
void describe(Visitor& v, GroundOptions& o) {
  v.field("cell_m", o.cell_m, "heights are taken over the lowest point of 3 x 3 cells of this size, metres");
  v.field("clearance_m", o.clearance_m, "points lower than this are ground, metres");
  v.field("flat_clearance_m", o.flat_clearance_m, "points of level surfaces lower than this are ground too, metres");
  v.field("flat_cosine", o.flat_cosine, "a surface is level when the z of its normal is above this");
}

inline void check(const GroundOptions& o) { require_option(o.cell_m > 0, "cell_m", "must be larger than 0"); }

/// Which points are probably ground: low over the lowest of their surroundings. A crude test, meant to keep the
/// sensor's own ground rings out of feature matching; z must point up to within some degrees. `normals` may be empty.
std::vector<bool> ground_points(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                                const GroundOptions& options = {});

}  // namespace loopmark::features

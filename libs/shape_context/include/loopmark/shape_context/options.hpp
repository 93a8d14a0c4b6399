// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "loopmark/core/options.hpp"

namespace loopmark::shape_context {

/// Options of the Fourier shape context (fourier_shape_context.hpp).
struct Options {
  double radius_m = 12.0;
  double keypoint_m = 0.5;
  double min_height_m = 0.4;
  double max_height_m = 12.0;
  double max_range_m = 60.0;
  std::size_t max_keypoints = 1500;
};

template <class Visitor>
void describe(Visitor& v, Options& o) {
  v.field("radius_m", o.radius_m, "structure within this distance, seen from above, describes a keypoint, metres");
  v.field("keypoint_m", o.keypoint_m, "one keypoint for each column of this edge that holds structure, metres");
  v.field("min_height_m", o.min_height_m, "structure: points higher above the ground than this, metres, ...");
  v.field("max_height_m", o.max_height_m, "... and lower than this, metres");
  v.field("max_range_m", o.max_range_m, "keypoints are nearer to the sensor than this, metres");
  v.field("max_keypoints", o.max_keypoints, "keypoints of a scan at most: those with the tallest structure");
}

inline void check(const Options& o) {
  require_option(o.radius_m > 0, "radius_m", "must be larger than 0");
  require_option(o.keypoint_m > 0, "keypoint_m", "must be larger than 0");
  require_option(o.max_height_m > o.min_height_m, "max_height_m", "must be larger than min_height_m");
  require_option(o.max_range_m > 0, "max_range_m", "must be larger than 0");
  require_option(o.max_keypoints > 0, "max_keypoints", "must be 1 or more");
}

}  // namespace loopmark::shape_context

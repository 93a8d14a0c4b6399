// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "loopmark/occupancy/occupancy_options.hpp"

namespace loopmark::occupancy::internal {

/// The update of a voxel, in single precision and in the order that OctoMap uses.
struct LogOdds {
  float hit;
  float miss;
  float low;
  float high;

  explicit LogOdds(const OccupancyOptions& o)
      : hit(of(o.hit_probability)),
        miss(of(o.miss_probability)),
        low(of(o.min_probability)),
        high(of(o.max_probability)) {}

  static float of(double probability) { return static_cast<float>(std::log(probability / (1.0 - probability))); }

  /// The value after one more observation; a voxel that is unknown (NaN) starts at zero.
  float updated(float value, float observation) const {
    const float sum = (std::isnan(value) ? 0.0F : value) + observation;
    return std::min(std::max(sum, low), high);
  }
};

}  // namespace loopmark::occupancy::internal

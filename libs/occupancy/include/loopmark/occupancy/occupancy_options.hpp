// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "loopmark/core/options.hpp"

namespace loopmark::occupancy {

/// Options of the occupancy map; probabilities are OctoMap's own defaults.
struct OccupancyOptions {
  double resolution_m = 0.2;        ///< edge of the smallest voxel, metres
  double max_range_m = 50.0;        ///< rays are cut there; what lies beyond is free up to there and not occupied
  double hit_probability = 0.7;     ///< of being occupied, for a voxel that holds a point
  double miss_probability = 0.4;    ///< of being occupied, for a voxel that a ray passes
  double min_probability = 0.1192;  ///< clamping: how sure of free a voxel can get
  double max_probability = 0.971;   ///< clamping: how sure of occupied a voxel can get
  std::size_t memory_mb = 256;      ///< voxels kept in memory; others wait on the disk
};

template <class Visitor>
void describe(Visitor& v, OccupancyOptions& o) {
  v.field("resolution_m", o.resolution_m, "edge of the smallest voxel, metres");
  v.field("max_range_m", o.max_range_m, "rays are cut there, metres");
  v.field("hit_probability", o.hit_probability, "of being occupied, for a voxel that holds a point");
  v.field("miss_probability", o.miss_probability, "of being occupied, for a voxel that a ray passes");
  v.field("min_probability", o.min_probability, "clamping: how sure of free a voxel can get");
  v.field("max_probability", o.max_probability, "clamping: how sure of occupied a voxel can get");
  v.field("memory_mb", o.memory_mb, "voxels kept in memory; others wait on the disk");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const OccupancyOptions& options);

}  // namespace loopmark::occupancy

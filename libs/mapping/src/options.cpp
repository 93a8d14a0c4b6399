// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/options.hpp"

namespace loopmark::mapping {

void check(const SlamOptions& o) {
  require_option(o.keyframe_m > 0.0, "keyframe_m", "must be positive");
  require_option(o.keyframe_deg > 0.0, "keyframe_deg", "must be positive");
  require_option(o.keyframe_voxel_m > 0.0, "keyframe_voxel_m", "must be positive");
  require_option(o.cloud_voxel_m > 0.0, "cloud_voxel_m", "must be positive");
  require_option(o.min_loop_p >= 0.0 && o.min_loop_p <= 1.0, "min_loop_p", "must be 0 to 1");
  require_option(o.drift_m_per_m >= 0.0 && o.drift_deg_per_m >= 0.0, "drift_m_per_m", "must not be negative");
  require_option(o.floor_m > 0.0 && o.floor_deg > 0.0, "floor_m", "must be positive");
  require_option(o.max_gap_s > 0.0, "max_gap_s", "must be positive");
  require_option(o.submap_keyframes >= 1, "submap_keyframes", "must be at least 1");
}

}  // namespace loopmark::mapping

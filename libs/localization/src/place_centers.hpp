// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::localization::internal {

/// Submaps stand around few keyframes, so that one that was made serves many scans. For each keyframe, the one at the
/// center of its submap: the nearest center within `near_m`, or itself where there is none among those before it.
std::vector<std::size_t> place_centers(const std::vector<Pose>& T_map_keyframe, double near_m);

}  // namespace loopmark::localization::internal

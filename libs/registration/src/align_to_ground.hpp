// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// From a motion in the plane to one in space: the ground of one scan is laid on that of the other.
#pragma once

#include "prepared_data.hpp"

namespace loopmark::registration::internal {

/// Lifts and tilts T_target_source (levelled frames) so that the ground surfels of the source lie on the ground that
/// the target saw, by robust least squares over z, roll and pitch. Unchanged where fewer than 20 surfels come to lie on
/// seen ground. Over hills, two levelled scans 60 m apart differ by metres and degrees, which is more than alignment
/// mends.
Pose align_to_ground(const Pose& T_target_source, const std::vector<surfels::Surfel>& source_ground,
                     const bev::GroundMap& target);

}  // namespace loopmark::registration::internal

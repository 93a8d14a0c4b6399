// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "loopmark/simulation/lane_path.hpp"
#include "loopmark/simulation/town.hpp"

namespace loopmark::simulation {

/// Names that plan_route() knows:
///   tour     revisits in the same and in the opposite direction and crossing, U-turns, alike blocks
///   explore  as many different streets as possible
///   twins    up and down both rows of blocks that look alike
///   open     over the river, through the open land, and back
std::vector<std::string> route_names();

/// Plans a walk of at least `length_m` metres. It depends on the town, the name and the length only, so that drives
/// on different days can follow it. Throws InputError for an unknown name.
Route plan_route(const Town& town, const std::string& name, double length_m);

}  // namespace loopmark::simulation

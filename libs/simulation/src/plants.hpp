// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/core/random.hpp"
#include "loopmark/simulation/mesh.hpp"

namespace loopmark::simulation::internal {

/// A tree at the origin: trunk, branches, and a crown of loose leaves that beams pass through in part.
struct TreeSpec {
  double height = 8.0;
  double crown_radius = 2.4;
  double trunk_radius = 0.16;
  double crown_base = 2.4;  ///< height of the lowest leaves
  int leaves = 340;
};
Mesh make_tree(const TreeSpec& spec, Rng& rng);

/// A bush at the origin.
Mesh make_bush(double radius, double height, Rng& rng);

/// A trimmed hedge along x from 0 to `length`, centred on y = 0, with an uneven face.
Mesh make_hedge(double length, double width, double height, Rng& rng);

}  // namespace loopmark::simulation::internal

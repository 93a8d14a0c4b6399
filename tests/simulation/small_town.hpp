// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/simulation/world.hpp"

namespace loopmark::simulation {

/// A small town that the tests of this program share.
inline const Town& small_town() {
  static const Town town = make_town({3, 4, 4, 0.06});
  return town;
}

inline const World& small_world() {
  static const World world(small_town(), 1);
  return world;
}

/// A level square of `half` metres around the origin at height 0.
inline Mesh flat_ground(double half) {
  Mesh mesh;
  add_quad(mesh, {-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}, {Material::kPlaster, 255});
  return mesh;
}

}  // namespace loopmark::simulation

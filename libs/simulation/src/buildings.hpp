// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "loopmark/simulation/mesh.hpp"

namespace loopmark::simulation::internal {

enum class Roof : std::uint8_t { kFlat, kGable };

/// The look of a facade; lengths in metres.
struct FacadeStyle {
  Material wall = Material::kPlaster;
  double window_pitch = 2.8;
  double window_width = 1.3;
  double window_height = 1.5;
  double recess = 0.18;     ///< how far the windows lie behind the wall
  double ledge = 0.06;      ///< band between the floors; 0: none
  int balcony_every = 0;    ///< every n-th column has balconies; 0: none
  bool shop_front = false;  ///< wide openings on the ground floor
  bool bay = false;         ///< a bay stands out over the ground floor
};

/// A building. Its frame: origin at the left end of the street front, x along the front, y into the lot, z up.
struct BuildingSpec {
  double width = 10.0;
  double depth = 9.0;
  int floors = 3;
  double floor_height = 2.9;
  Roof roof = Roof::kFlat;
  FacadeStyle style;
  bool joined_left = false;  ///< another house stands against this side: no windows
  bool joined_right = false;
  double below = 1.0;  ///< how far the walls reach below the origin, for sloping ground
  std::uint64_t seed = 0;
};

/// Walls with windows, doors, balconies and ledges, and a roof with what stands on it.
Mesh make_building(const BuildingSpec& spec);

}  // namespace loopmark::simulation::internal

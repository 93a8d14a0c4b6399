// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/simulation/mesh.hpp"
#include "loopmark/simulation/road_network.hpp"
#include "loopmark/simulation/terrain.hpp"

namespace loopmark::simulation {

struct TownOptions {
  std::uint64_t seed = 1;   ///< another seed, another town
  int columns = 6;          ///< blocks along x
  int rows = 5;             ///< blocks along y
  double max_slope = 0.06;  ///< of the streets, rise over run
};

template <class Visitor>
void describe(Visitor& v, TownOptions& o) {
  v.field("seed", o.seed, "another seed, another town");
  v.field("columns", o.columns, "blocks along x");
  v.field("rows", o.rows, "blocks along y");
  v.field("max_slope", o.max_slope, "steepest street, rise over run");
}

void check(const TownOptions& options);

/// A place where a car may stand on some days.
struct ParkingPlace {
  Pose T_world_car = Pose::Identity();
  double chance = 0.5;  ///< share of days on which it is taken
};

/// What stays the same from day to day. World frame: x east, y north, z up, metres.
struct Town {
  TownOptions options;
  RoadNetwork roads;
  Terrain terrain;
  Mesh mesh;
  std::vector<ParkingPlace> parking;
};

/// Builds the town of a seed. Throws InputError when the options make no sense.
Town make_town(const TownOptions& options);

/// Height of the kerb above the carriageway, metres, and fall of the carriageway from its crown, metres a metre.
inline constexpr double kKerbHeight = 0.12;
inline constexpr double kCamber = 0.015;

}  // namespace loopmark::simulation

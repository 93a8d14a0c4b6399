// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ground_plan.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/simulation/town.hpp"

namespace loopmark::simulation::internal {

/// A town while it is being built.
struct Builder {
  Town& town;
  GroundPlan& plan;

  double ground(const Eigen::Vector2d& p) const { return town.terrain.ground(p) + kKerbHeight; }
  /// Puts a mesh on the ground, turned by `yaw`.
  void put(const Mesh& mesh, const Eigen::Vector2d& p, double yaw);
};

/// One side of a street, walked from its `from` end (or from the other end for a turned template).
struct Frontage {
  const RoadEdge& edge;
  double side;  ///< +1 left of the direction of walking, -1 right
  double length;

  Frontage(const RoadEdge& e, double which_side);
  /// The point `distance` metres on, `offset` metres outwards from the centre line; tangent along the walk.
  LinePoint at(double distance, double offset) const;
  /// Offset of the line where lots begin.
  double lots_offset() const { return edge.half_width_m + edge.sidewalk_m + 0.3; }
};

/// Marks streets, river and islands in the plan.
void mark_streets(Builder& b);
/// Carriageways, junctions, kerbs, sidewalks, bridges.
void add_streets(Builder& b);
/// Open ground, once everything else is marked.
void add_open_ground(Builder& b, std::uint64_t seed);
/// Lamps, signs, street trees, bins, guard rails, parking strips of one street.
void furnish_street(Builder& b, const RoadEdge& edge, std::uint64_t seed);
/// Buildings and gardens on both sides of one street.
void build_parcels(Builder& b, const RoadEdge& edge, std::uint64_t seed);
/// Trees, bushes and sheds where nothing else stands.
void fill_free_ground(Builder& b, std::uint64_t seed);

}  // namespace loopmark::simulation::internal

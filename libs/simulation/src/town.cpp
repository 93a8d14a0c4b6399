// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/town.hpp"

#include <cmath>

#include "builder.hpp"
#include "loopmark/core/options.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::simulation {

void check(const TownOptions& o) {
  require_option(o.columns >= 4 && o.columns <= 40, "town.columns", "must lie between 4 and 40");
  require_option(o.rows >= 4 && o.rows <= 40, "town.rows", "must lie between 4 and 40");
  require_option(o.max_slope >= 0.0 && o.max_slope <= 0.15, "town.max_slope", "must lie between 0 and 0.15");
}

void internal::Builder::put(const Mesh& mesh, const Eigen::Vector2d& p, double yaw) {
  append(town.mesh, mesh, pose_from_yaw(yaw, {p.x(), p.y(), ground(p)}));
}

internal::Frontage::Frontage(const RoadEdge& e, double which_side)
    : edge(e), side(which_side), length(line_length(e.line)) {}

LinePoint internal::Frontage::at(double distance, double offset) const {
  LinePoint p = line_at(edge.line, edge.turned ? length - distance : distance);
  if (edge.turned) {
    p.tangent = -p.tangent;
  }
  p.position -= side * offset * p.right();
  return p;
}

namespace {

/// Alike blocks share one seed, so that each is furnished like the next.
std::uint64_t street_seed(const Town& town, std::size_t edge) {
  const std::uint64_t name = town.roads.edges[edge].near_identical ? 1000000 : edge;
  return task_seed(town.options.seed, {10, name});
}

}  // namespace

Town make_town(const TownOptions& options) {
  check(options);
  Town town;
  town.options = options;
  RoadLayout layout = make_roads({options.seed, options.columns, options.rows});
  town.roads = std::move(layout.network);
  town.terrain =
      Terrain(options.seed, {layout.low, layout.high, layout.level_rows_y, layout.river_x, options.max_slope});
  internal::GroundPlan plan(layout.low, layout.high);
  internal::Builder builder{town, plan};
  internal::mark_streets(builder);
  internal::add_streets(builder);
  for (const bool alike : {true, false}) {  // the alike blocks first, so that no neighbour changes them
    for (std::size_t e = 0; e < town.roads.edges.size(); ++e) {
      if (town.roads.edges[e].near_identical == alike) {
        internal::build_parcels(builder, town.roads.edges[e], street_seed(town, e));
      }
    }
  }
  for (std::size_t e = 0; e < town.roads.edges.size(); ++e) {
    internal::furnish_street(builder, town.roads.edges[e], task_seed(street_seed(town, e), {1}));
  }
  internal::fill_free_ground(builder, task_seed(options.seed, {11}));
  internal::add_open_ground(builder, task_seed(options.seed, {12}));
  return town;
}

}  // namespace loopmark::simulation

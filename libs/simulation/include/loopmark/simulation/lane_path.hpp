// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "loopmark/simulation/road_network.hpp"

namespace loopmark::simulation {

/// A walk over the street graph. The same edge twice in a row is a U-turn.
struct Route {
  int start = 0;  ///< node
  std::vector<int> edges;

  /// The walk from its end back to its start.
  Route reversed(const RoadNetwork& roads) const;
  /// The nodes passed, start and end included.
  std::vector<int> nodes(const RoadNetwork& roads) const;
};

/// The smooth line that a vehicle follows, with a sample every kPathStep metres.
inline constexpr double kPathStep = 0.25;
struct LanePath {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> heading_rad;  ///< unwrapped
  std::vector<int> edge;            ///< street of each sample

  double length() const { return points.empty() ? 0.0 : kPathStep * static_cast<double>(points.size() - 1); }
  Eigen::Vector2d position(double distance) const;
  double heading(double distance) const;
  /// Change of heading, radians a metre.
  double curvature(double distance) const;
};

/// Follows a route `offset_m` metres right of the centre line (negative: left), round corners, around roundabouts
/// anticlockwise, and with room to turn at U-turns. Starts and ends in the middle of the first and last street.
LanePath make_lane_path(const RoadNetwork& roads, const Route& route, double offset_m);

}  // namespace loopmark::simulation

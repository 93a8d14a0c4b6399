// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace loopmark::simulation {

/// What stands along a street.
enum class Zone : std::uint8_t { kTerraced, kApartments, kVillas, kCommercial, kPark, kOpen, kTwins };

/// A junction, or the end of a bend.
struct RoadNode {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  std::vector<int> edges;
  bool roundabout = false;
};

/// A street between two nodes. Traffic keeps to the right.
struct RoadEdge {
  int from = 0;
  int to = 0;
  std::vector<Eigen::Vector2d> line;  ///< centre line, about a point a metre
  double half_width_m = 5.0;          ///< to the kerb
  double sidewalk_m = 2.4;            ///< 0: no sidewalk
  double speed_limit_mps = 11.0;
  Zone zone = Zone::kTerraced;
  bool near_identical = false;  ///< one of a row of blocks that look alike
  bool turned = false;          ///< its furnishing is the template turned by half a turn
};

struct RoadNetwork {
  std::vector<RoadNode> nodes;
  std::vector<RoadEdge> edges;

  int other_end(int edge, int node) const;
};

/// A point of a polyline.
struct LinePoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  Eigen::Vector2d tangent = Eigen::Vector2d::UnitX();
  /// Unit vector to the right of the tangent.
  Eigen::Vector2d right() const { return {tangent.y(), -tangent.x()}; }
};

double line_length(const std::vector<Eigen::Vector2d>& line);
/// The point at `distance` metres along the line (clamped to its ends).
LinePoint line_at(const std::vector<Eigen::Vector2d>& line, double distance);

/// How the streets are laid out.
struct RoadPlan {
  std::uint64_t seed = 1;
  int columns = 6;  ///< blocks along x
  int rows = 5;     ///< blocks along y
};

/// A grid with uneven spacing, bent streets and missing links, two rows of equal blocks (first and last row), a
/// roundabout, and a road over the river through open land. `river_x`, `low`, `high` receive the land's layout.
struct RoadLayout {
  RoadNetwork network;
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  double river_x = 0.0;
  std::vector<double> level_rows_y;
};
RoadLayout make_roads(const RoadPlan& plan);

}  // namespace loopmark::simulation

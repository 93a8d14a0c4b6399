// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The ground: streets as strips with kerbs and sidewalks, junction discs, bridges, open ground.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "builder.hpp"

namespace loopmark::simulation::internal {
namespace {

constexpr Surface kAsphalt = {Material::kAsphalt, 128};
constexpr Surface kPaving = {Material::kPaving, 128};
constexpr double kRoundabout = 14.0;
constexpr double kIsland = 5.5;

double junction_radius(const RoadNetwork& roads, const RoadNode& node) {
  double radius = 0.0;
  for (const int e : node.edges) {
    radius = std::max(radius, roads.edges[e].half_width_m);
  }
  return node.roundabout ? kRoundabout : radius + 1.0;
}

/// A point of a street's cross-section: `offset` metres right of the centre line, raised by `rise`.
Eigen::Vector3d street_point(const Town& town, const LinePoint& p, double offset, double rise) {
  const Eigen::Vector2d at = p.position + offset * p.right();
  const double uneven = 0.006 * place_noise(town.options.seed, at, 0.9);
  return {at.x(), at.y(), town.terrain.road(at) + rise + uneven};
}

void add_strip(Builder& b, const RoadEdge& edge, double from, double to, double rise_from, double rise_to,
               Surface surface, bool skip_on_carriageway) {
  std::vector<LinePoint> points;
  const double length = line_length(edge.line);
  const int count = std::max(2, static_cast<int>(length));
  for (int i = 0; i <= count; ++i) {
    points.push_back(line_at(edge.line, length * i / count));
  }
  for (int i = 0; i < count; ++i) {
    const LinePoint& p = points[static_cast<std::size_t>(i)];
    const LinePoint& q = points[static_cast<std::size_t>(i) + 1];
    const double probe = edge.half_width_m + 0.9;
    const Eigen::Vector2d middle = 0.5 * (p.position + q.position) + (from + to < 0.0 ? -probe : probe) * p.right();
    if (skip_on_carriageway && b.plan.at(middle) == GroundUse::kCarriageway) {
      continue;
    }
    add_quad(b.town.mesh, street_point(b.town, p, from, rise_from), street_point(b.town, p, to, rise_to),
             street_point(b.town, q, to, rise_to), street_point(b.town, q, from, rise_from), surface);
  }
}

void add_carriageway(Builder& b, const RoadEdge& edge) {
  const double w = edge.half_width_m;
  constexpr int kLanes = 6;
  for (int i = 0; i < kLanes; ++i) {
    const double from = w * (2.0 * i / kLanes - 1.0);
    const double to = w * (2.0 * (i + 1) / kLanes - 1.0);
    add_strip(b, edge, from, to, -kCamber * std::abs(from), -kCamber * std::abs(to), kAsphalt, false);
  }
  if (edge.sidewalk_m > 0.0) {
    for (const double side : {-1.0, 1.0}) {
      add_strip(b, edge, side * w, side * (w + 0.01), -kCamber * w, kKerbHeight, {Material::kConcrete, 160}, true);
      add_strip(b, edge, side * (w + 0.01), side * (w + edge.sidewalk_m), kKerbHeight, kKerbHeight + 0.03, kPaving,
                true);
    }
  }
}

void add_disc(Builder& b, const Eigen::Vector2d& centre, double radius, double rise, Surface surface) {
  constexpr int kSpokes = 24;
  const auto point = [&](double r, int spoke) {
    const double angle = 2.0 * std::numbers::pi * spoke / kSpokes;
    const Eigen::Vector2d at = centre + r * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    return Eigen::Vector3d(at.x(), at.y(), b.town.terrain.road(at) + rise);
  };
  for (int spoke = 0; spoke < kSpokes; ++spoke) {
    add_triangle(b.town.mesh, point(0, 0), point(0.5 * radius, spoke), point(0.5 * radius, spoke + 1), surface);
    add_quad(b.town.mesh, point(0.5 * radius, spoke), point(radius, spoke), point(radius, spoke + 1),
             point(0.5 * radius, spoke + 1), surface);
  }
}

void add_island(Builder& b, const Eigen::Vector2d& centre) {
  const double z = b.town.terrain.road(centre);
  const Eigen::Vector3d foot(centre.x(), centre.y(), z - 0.3);
  add_column(b.town.mesh, foot, foot + Eigen::Vector3d(0, 0, 0.5), kIsland, kIsland, 24, {Material::kConcrete, 150});
  add_column(b.town.mesh, foot, foot + Eigen::Vector3d(0, 0, 1.0), kIsland - 0.8, 2.0, 20, {Material::kGrass, 128});
}

/// Deck slab, parapets and guard rails where a street crosses the river.
void add_bridge(Builder& b, const RoadEdge& edge) {
  const double length = line_length(edge.line);
  for (double s = 0.0; s + 2.0 <= length; s += 2.0) {
    const LinePoint p = line_at(edge.line, s + 1.0);
    if (b.town.terrain.river_distance(p.position) > 20.0) {
      continue;
    }
    Pose frame = pose_from_yaw(std::atan2(p.tangent.y(), p.tangent.x()),
                               {p.position.x(), p.position.y(), b.town.terrain.road(p.position)});
    const double w = edge.half_width_m;
    add_box(b.town.mesh, frame, {-1.1, -w - 0.4, -0.9}, {1.1, w + 0.4, -0.14}, {Material::kConcrete, 128});
    for (const double side : {-1.0, 1.0}) {
      const double y = side * (w + 0.2);
      add_box(b.town.mesh, frame, {-1.05, y - 0.15, -0.3}, {1.05, y + 0.15, 0.45}, {Material::kConcrete, 140});
      add_box(b.town.mesh, frame, {-1.05, y - 0.04, 0.95}, {1.05, y + 0.04, 1.05}, {Material::kMetal, 140});
      add_box(b.town.mesh, frame, {-0.04, y - 0.04, 0.45}, {0.04, y + 0.04, 1.0}, {Material::kMetal, 140});
    }
  }
}

/// Height of an open-ground vertex; below the streets it stays under their strips.
double open_height(const Builder& b, const Eigen::Vector2d& p, std::uint64_t seed) {
  const double base = b.town.terrain.ground(p);
  switch (b.plan.at(p)) {
    case GroundUse::kCarriageway:
      return base - 0.3;
    case GroundUse::kSidewalk:
      return base - 0.02;
    case GroundUse::kWater:
      return base;
    default:
      return base + 0.10 + 0.05 * place_noise(seed, p, 3.0) + 0.10 * place_noise(seed + 1, p, 11.0);
  }
}

}  // namespace

void mark_streets(Builder& b) {
  const auto& roads = b.town.roads;
  for (const RoadEdge& edge : roads.edges) {
    b.plan.mark_line(edge.line, edge.half_width_m, GroundUse::kCarriageway, true);
  }
  for (const RoadNode& node : roads.nodes) {
    b.plan.mark_disc(node.position, junction_radius(roads, node), GroundUse::kCarriageway);
  }
  for (const RoadEdge& edge : roads.edges) {
    b.plan.mark_line(edge.line, edge.half_width_m + std::max(1.5, edge.sidewalk_m), GroundUse::kSidewalk, false);
  }
  const auto& land = b.town.terrain.layout();
  for (double y = land.low.y(); y < land.high.y(); y += 0.5) {
    for (double x = land.river_x - 35.0; x < land.river_x + 35.0; x += 0.5) {
      if (b.town.terrain.river_depth({x, y}) > 0.02 && b.plan.at({x, y}) == GroundUse::kFree) {
        b.plan.mark_disc({x, y}, 0.2, GroundUse::kWater);
      }
    }
  }
}

void add_streets(Builder& b) {
  for (const RoadEdge& edge : b.town.roads.edges) {
    add_carriageway(b, edge);
    add_bridge(b, edge);
  }
  for (const RoadNode& node : b.town.roads.nodes) {
    add_disc(b, node.position, junction_radius(b.town.roads, node), -0.02, kAsphalt);
    if (node.roundabout) {
      add_island(b, node.position);
    }
  }
}

void add_open_ground(Builder& b, std::uint64_t seed) {
  constexpr double kStep = 2.0;
  const auto& land = b.town.terrain.layout();
  const Eigen::Vector2i count = ((land.high - land.low) / kStep).cast<int>();
  Mesh& mesh = b.town.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= count.y(); ++j) {
    for (int i = 0; i <= count.x(); ++i) {
      const Eigen::Vector2d p = land.low + kStep * Eigen::Vector2d(i, j);
      mesh.vertices.push_back(Eigen::Vector3d(p.x(), p.y(), open_height(b, p, seed)).cast<float>());
    }
  }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (count.x() + 1) + i); };
  for (int j = 0; j < count.y(); ++j) {
    for (int i = 0; i < count.x(); ++i) {
      const Eigen::Vector2d middle = land.low + kStep * Eigen::Vector2d(i + 0.5, j + 0.5);
      const bool water = b.town.terrain.river_depth(middle) > 4.2;
      const Surface surface = {water ? Material::kWater : Material::kGrass, 128};
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      mesh.surfaces.insert(mesh.surfaces.end(), 2, surface);
    }
  }
}

}  // namespace loopmark::simulation::internal

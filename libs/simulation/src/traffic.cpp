// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/traffic.hpp"

#include <cmath>
#include <numbers>

#include "loopmark/core/random.hpp"

namespace loopmark::simulation {
namespace {

constexpr double kEgoLength = 5.2;
constexpr double kEgoWidth = 2.3;

Route wander(const RoadNetwork& roads, int streets, Rng& rng) {
  Route route;
  route.start = static_cast<int>(rng.below(static_cast<std::uint32_t>(roads.nodes.size())));
  int node = route.start;
  for (int i = 0; i < streets; ++i) {
    const std::vector<int>& edges = roads.nodes[node].edges;
    int next = edges[rng.below(static_cast<std::uint32_t>(edges.size()))];
    if (!route.edges.empty() && next == route.edges.back()) {
      next = edges[(rng.below(static_cast<std::uint32_t>(edges.size())) + 1) % edges.size()];
    }
    route.edges.push_back(next);
    node = roads.other_end(next, node);
  }
  return route;
}

/// A walk along one sidewalk, clear of the junctions.
LanePath sidewalk(const RoadEdge& edge, int index, double side) {
  LanePath path;
  const double length = line_length(edge.line);
  for (double s = 9.0; s < length - 9.0; s += kPathStep) {
    const LinePoint p = line_at(edge.line, s);
    path.points.emplace_back(p.position + side * (edge.half_width_m + 0.6 * edge.sidewalk_m) * p.right());
    path.heading_rad.push_back(std::atan2(p.tangent.y(), p.tangent.x()));
    path.edge.push_back(index);
  }
  return path;
}

/// Between two poses a body is drawn by interpolated matrices, which are none half way round.
constexpr double kLargestTurnDeg = 45.0;

}  // namespace

Traffic::Traffic(const Town& town, const ShapeList& shapes, const TrafficOptions& options, std::uint64_t seed)
    : town_(&town) {
  for (int i = 0; i < options.vehicles; ++i) {
    Rng rng(task_seed(seed, {40, static_cast<std::uint64_t>(i)}));
    paths_.push_back(make_lane_path(town.roads, wander(town.roads, 30, rng), 1.75));
    const std::size_t kind =
        rng.uniform() < 0.8 ? rng.below(4) : rng.below(static_cast<std::uint32_t>(shapes.vehicles));
    actors_.push_back(
        {kind, paths_.size() - 1, rng.uniform() * paths_.back().length(), rng.uniform(5.0, 11.0), false, -0.02});
  }
  for (int i = 0; i < options.pedestrians; ++i) {
    Rng rng(task_seed(seed, {41, static_cast<std::uint64_t>(i)}));
    const int street = static_cast<int>(rng.below(static_cast<std::uint32_t>(town.roads.edges.size())));
    const RoadEdge& edge = town.roads.edges[street];
    LanePath path = sidewalk(edge, street, rng.uniform() < 0.5 ? -1.0 : 1.0);
    if (edge.sidewalk_m <= 0.0 || path.points.size() < 8) {
      continue;
    }
    paths_.push_back(std::move(path));
    const std::size_t shape =
        shapes.vehicles + rng.below(static_cast<std::uint32_t>(shapes.meshes.size() - shapes.vehicles));
    actors_.push_back({shape, paths_.size() - 1, rng.uniform() * paths_.back().length(), rng.uniform(0.7, 1.7), true,
                       kKerbHeight + 0.03});
  }
}

Pose Traffic::pose(const Actor& actor, double time_s) const {
  const LanePath& path = paths_[actor.path];
  const double whole = actor.to_and_fro ? 2.0 * path.length() : path.length();
  double s = std::fmod(actor.start_m + actor.speed_mps * (time_s + 1e4), whole);
  const bool back = actor.to_and_fro && s > path.length();
  s = back ? whole - s : s;
  const Eigen::Vector2d p = path.position(s);
  const double yaw = path.heading(s) + (back ? std::numbers::pi : 0.0);
  return pose_from_yaw(yaw, {p.x(), p.y(), town_->terrain.road(p) + actor.rise_m});
}

std::vector<MovingBody> Traffic::bodies(double begin_s, double end_s, const Pose& T_world_ego, double radius) const {
  std::vector<MovingBody> list;
  for (const Actor& actor : actors_) {
    const Pose start = pose(actor, begin_s);
    Pose end = pose(actor, end_s);
    const PoseError moved = pose_error(end, start);
    if (moved.translation_m > 20.0 * (end_s - begin_s) + 1.0 || moved.rotation_deg > kLargestTurnDeg) {
      end = start;  // it has just started over, or turned round
    }
    const Eigen::Vector3d seen = T_world_ego.inverse() * start.translation();
    const bool touches = std::abs(seen.x()) < kEgoLength + 1.0 && std::abs(seen.y()) < kEgoWidth;
    if (seen.norm() < radius && !touches) {
      list.push_back({actor.shape, start, end});
    }
  }
  return list;
}

}  // namespace loopmark::simulation

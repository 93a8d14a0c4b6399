// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "street_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopmark::simulation::internal {
namespace {

constexpr double kLane = 1.75;

}  // namespace

StreetPlaces::StreetPlaces(const Town& town) : town_(&town) {
  for (const RoadEdge& edge : town.roads.edges) {
    const double length = line_length(edge.line);
    for (double s = 1.0; s < length; s += 2.0) {
      const LinePoint p = line_at(edge.line, s);
      const double along = std::atan2(p.tangent.y(), p.tangent.x());
      places_.push_back({p.position + kLane * p.right(), along, edge.near_identical});
      places_.push_back({p.position - kLane * p.right(), along + std::numbers::pi, edge.near_identical});
    }
  }
}

StreetPlace StreetPlaces::any(Rng& rng) const { return places_[rng.below(static_cast<std::uint32_t>(places_.size()))]; }

StreetPlace StreetPlaces::at_distance(const Eigen::Vector2d& p, double low, double high, Rng& rng) const {
  std::vector<std::size_t> fitting;
  std::size_t nearest = 0;
  double least = 1e9;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double distance = (places_[i].position - p).norm();
    if (distance >= low && distance <= high) {
      fitting.push_back(i);
    }
    const double off = std::abs(distance - 0.5 * (low + high));
    if (off < least) {
      least = off;
      nearest = i;
    }
  }
  return places_[fitting.empty() ? nearest : fitting[rng.below(static_cast<std::uint32_t>(fitting.size()))]];
}

std::pair<StreetPlace, StreetPlace> StreetPlaces::alike(Rng& rng) const {
  const auto& nodes = town_->roads.nodes;
  const int columns = town_->options.columns;
  const Eigen::Vector2d first = nodes.front().position;
  const Eigen::Vector2d last = nodes[static_cast<std::size_t>((columns + 1) * (town_->options.rows + 1)) - 1].position;
  const double block = (last.x() - first.x()) / columns;
  const double within = rng.uniform(0.1, 0.9) * block;
  const double side = rng.uniform() < 0.5 ? -1.0 : 1.0;
  const auto from = static_cast<double>(rng.below(static_cast<std::uint32_t>(columns)));
  const double y = first.y() - side * kLane;
  const StreetPlace a = {{first.x() + from * block + within, y}, side > 0.0 ? 0.0 : std::numbers::pi, true};
  const auto to = static_cast<double>(rng.below(static_cast<std::uint32_t>(columns)));
  if (std::abs(to - from) >= 4.0 && rng.uniform() < 0.5) {
    return {a, {{first.x() + to * block + within, y}, a.heading_rad, true}};
  }
  const Eigen::Vector2d turned = first + last - Eigen::Vector2d(first.x() + to * block + within, y);
  return {a, {turned, a.heading_rad + std::numbers::pi, true}};
}

}  // namespace loopmark::simulation::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What stands behind the sidewalks: houses with gardens, blocks of flats, shops with car parks, parks.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "builder.hpp"
#include "buildings.hpp"
#include "plants.hpp"

namespace loopmark::simulation::internal {
namespace {

/// How one zone builds; ranges are drawn anew for each lot, the setback once a street.
struct ZoneStyle {
  double width_low, width_high, depth_low, depth_high, setback_low, setback_high, gap_low, gap_high;
  int floors_low, floors_high;
};

ZoneStyle style_of(Zone zone) {
  switch (zone) {
    case Zone::kApartments:
      return {15, 28, 11, 13.5, 2, 5.5, 3, 8, 3, 6};
    case Zone::kVillas:
      return {8.5, 12.5, 8, 10.5, 4, 7.5, 4, 8, 1, 2};
    case Zone::kCommercial:
      return {18, 34, 14, 20, 9, 14, 4, 10, 1, 2};
    case Zone::kTwins:
      return {9.2, 9.2, 9.5, 9.5, 3.2, 3.2, 3.2, 3.2, 2, 2};
    default:
      return {5.8, 9.2, 9, 11.5, 0.0, 2.2, 0, 0, 2, 4};
  }
}

class LotBuilder {
 public:
  LotBuilder(Builder& b, const RoadEdge& edge, double side, std::uint64_t seed)
      : b_(b), front_(edge, side), rng_(seed), style_(style_of(edge.zone)) {
    setback_ = rng_.uniform(style_.setback_low, style_.setback_high);
    street_floors_ =
        style_.floors_low +
        static_cast<int>(rng_.below(static_cast<std::uint32_t>(style_.floors_high - style_.floors_low + 1)));
    wall_ = rng_.uniform() < 0.5 ? Material::kPlaster : Material::kBrick;
  }

  void run() {
    if (front_.edge.zone == Zone::kPark) {
      plant_park();
      return;
    }
    double s = front_.edge.near_identical ? 9.5 : 6.5;
    while (s < front_.length - 9.0) {
      const double width = rng_.uniform(style_.width_low, style_.width_high);
      const bool passage = front_.edge.zone == Zone::kTerraced && rng_.uniform() < 0.09;
      if (!passage && build(s, width)) {
        furnish_garden(s, width);
        s += width + rng_.uniform(style_.gap_low, style_.gap_high);
        joined_ = style_.gap_high <= 0.0;
      } else {
        s += passage ? rng_.uniform(2.5, 5.0) : 1.5;
        joined_ = false;
      }
    }
  }

 private:
  Footprint footprint(double s, double width, double depth) const {
    const double offset = front_.lots_offset() + setback_;
    const Eigen::Vector2d a = front_.at(s, offset).position;
    const Eigen::Vector2d c = front_.at(s + width, offset).position;
    const Eigen::Vector2d along = (front_.side > 0.0 ? c - a : a - c).normalized();
    return {front_.side > 0.0 ? a : c, along, (c - a).norm(), depth};
  }

  bool build(double s, double width) {
    BuildingSpec spec = choose(width);
    const Footprint area = footprint(s, width, spec.depth);
    spec.width = area.width;
    Footprint inner = area;  // neighbours may touch
    inner.corner = area.point(0.4, 0.0);
    inner.width -= 0.8;
    if (s + width > front_.length - 5.0 || inner.width < 3.0 || !b_.plan.is_free(inner)) {
      return false;
    }
    double low = 1e9;
    for (const double u : {0.0, area.width}) {
      for (const double v : {0.0, area.depth}) {
        low = std::min(low, b_.town.terrain.ground(area.point(u, v)));
      }
    }
    const Eigen::Vector2d middle = area.point(0.5 * area.width, 0.0);
    const double z = b_.ground(middle);
    spec.below = z - low + 0.5;
    const double yaw = std::atan2(area.along.y(), area.along.x());
    append(b_.town.mesh, make_building(spec), pose_from_yaw(yaw, {area.corner.x(), area.corner.y(), z}));
    b_.plan.mark(area, GroundUse::kTaken);
    return true;
  }

  BuildingSpec choose(double width) {
    BuildingSpec spec;
    spec.width = width;
    spec.depth = rng_.uniform(style_.depth_low, style_.depth_high);
    const int change = rng_.uniform() < 0.3 ? static_cast<int>(rng_.below(3)) - 1 : 0;
    spec.floors = std::clamp(street_floors_ + change, style_.floors_low, style_.floors_high);
    spec.floor_height = rng_.uniform(2.7, 3.3);
    spec.seed = static_cast<std::uint64_t>(rng_.next());
    spec.style.wall = rng_.uniform() < 0.7 ? wall_ : Material::kPlaster;
    spec.style.window_pitch = rng_.uniform(2.3, 3.6);
    spec.style.window_width = rng_.uniform(0.9, 0.6 * spec.style.window_pitch);
    spec.style.window_height = rng_.uniform(1.2, 1.9);
    spec.style.recess = rng_.uniform(0.08, 0.32);
    spec.style.ledge = rng_.uniform() < 0.5 ? rng_.uniform(0.04, 0.14) : 0.0;
    spec.style.bay = rng_.uniform() < 0.2;
    const Zone zone = front_.edge.zone;
    spec.roof =
        zone == Zone::kCommercial || (zone == Zone::kApartments && rng_.uniform() < 0.7) ? Roof::kFlat : Roof::kGable;
    spec.style.shop_front = zone == Zone::kCommercial || (zone == Zone::kTerraced && rng_.uniform() < 0.2);
    spec.style.balcony_every = zone == Zone::kApartments ? 1 + static_cast<int>(rng_.below(3)) : 0;
    spec.joined_left = spec.joined_right = zone == Zone::kTerraced && joined_;
    if (zone == Zone::kCommercial) {
      spec.floor_height = rng_.uniform(3.6, 4.8);
    }
    return spec;
  }

  void furnish_garden(double s, double width) {
    if (setback_ < 2.0) {
      return;
    }
    front_border(s, width);
    const Zone zone = front_.edge.zone;
    if (zone == Zone::kCommercial) {
      car_park(s, width);
      return;
    }
    for (int i = 0; i < 3; ++i) {
      const double at = s + rng_.uniform(0.1, 0.9) * width;
      const Eigen::Vector2d p = front_.at(at, front_.lots_offset() + rng_.uniform(0.9, setback_ - 0.8)).position;
      Rng plant(rng_.next());
      if (rng_.uniform() < 0.3) {
        b_.put(make_tree({plant.uniform(3.5, 6.5), plant.uniform(1.0, 1.8), 0.09, 1.6, 200}, plant), p, 0.0);
      } else {
        b_.put(make_bush(plant.uniform(0.4, 0.9), plant.uniform(0.6, 1.5), plant), p, 0.0);
      }
    }
  }

  /// Hedge, wall, fence or nothing between garden and sidewalk, with a gate.
  void front_border(double s, double width) {
    const double kind = front_.edge.near_identical ? 0.2 : rng_.uniform();
    const double gate = rng_.uniform(0.2, 0.7) * width;
    for (const auto& [from, to] : {std::pair(0.0, gate), std::pair(gate + 1.6, width)}) {
      const LinePoint a = front_.at(s + from, front_.lots_offset());
      const LinePoint c = front_.at(s + to, front_.lots_offset());
      const double length = (c.position - a.position).norm();
      if (length < 0.8 || b_.plan.at(a.position) == GroundUse::kCarriageway) {
        continue;
      }
      const Eigen::Vector2d d = c.position - a.position;
      Mesh border;
      Rng shape(rng_.next());
      if (kind < 0.4) {
        border = make_hedge(length, 0.7, shape.uniform(0.8, 1.7), shape);
      } else if (kind < 0.65) {
        add_box(border, Pose::Identity(), {0, -0.12, -0.5}, {length, 0.12, shape.uniform(0.5, 1.2)},
                {Material::kBrick, 128});
      } else if (kind < 0.85) {
        add_fence(border, length);
      }
      b_.put(border, a.position, std::atan2(d.y(), d.x()));
    }
  }

  static void add_fence(Mesh& mesh, double length) {
    const Surface wood = {Material::kWood, 128};
    for (double x = 0.0; x < length; x += 0.22) {
      add_quad(mesh, {x, 0, -0.2}, {x + 0.1, 0, -0.2}, {x + 0.1, 0, 1.05}, {x, 0, 1.05}, wood);
    }
    for (double x = 0.0; x < length; x += 2.4) {
      add_box(mesh, Pose::Identity(), {x, -0.05, -0.3}, {x + 0.1, 0.05, 1.15}, wood);
    }
  }

  void car_park(double s, double width) {
    for (double at = s + 2.0; at + 2.0 < s + width; at += 2.6) {
      const LinePoint p = front_.at(at, front_.lots_offset() + 0.5 * setback_);
      const double yaw = std::atan2(p.tangent.y(), p.tangent.x()) + 0.5 * std::numbers::pi;
      b_.town.parking.push_back({pose_from_yaw(yaw, {p.position.x(), p.position.y(), b_.ground(p.position)}), 0.55});
    }
  }

  void plant_park() {
    for (double s = 8.0; s < front_.length - 8.0; s += rng_.uniform(3.0, 6.5)) {
      for (int row = 0; row < 3; ++row) {
        const Eigen::Vector2d p = front_.at(s, front_.lots_offset() + rng_.uniform(0.8, 26.0)).position;
        Rng plant(rng_.next());
        if (!b_.plan.is_free(p, 1.2)) {
          continue;
        }
        b_.plan.mark_disc(p, 1.0, GroundUse::kTaken);
        if (plant.uniform() < 0.6) {
          const double height = plant.uniform(6.0, 14.0);
          b_.put(make_tree({height, 0.28 * height, 0.03 * height, 0.25 * height, 420}, plant), p, 0.0);
        } else {
          b_.put(make_bush(plant.uniform(0.6, 1.6), plant.uniform(0.6, 2.0), plant), p, 0.0);
        }
      }
    }
  }

  Builder& b_;
  Frontage front_;
  Rng rng_;
  ZoneStyle style_;
  double setback_ = 0.0;
  int street_floors_ = 2;
  Material wall_ = Material::kPlaster;
  bool joined_ = false;
};

}  // namespace

void build_parcels(Builder& b, const RoadEdge& edge, std::uint64_t seed) {
  if (edge.zone == Zone::kOpen) {
    return;
  }
  for (const double side : {1.0, -1.0}) {
    LotBuilder(b, edge, side, task_seed(seed, {side > 0.0 ? 1ULL : 2ULL})).run();
  }
}

}  // namespace loopmark::simulation::internal

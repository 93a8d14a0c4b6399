// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What stands on the sidewalks and along country roads, and where cars park; and what grows on free ground.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "builder.hpp"
#include "plants.hpp"

namespace loopmark::simulation::internal {
namespace {

constexpr Surface kSteel = {Material::kMetal, 128};
const Pose kOrigin = Pose::Identity();

/// A lamp post at the origin, its arm along +y.
Mesh make_lamp(double height) {
  Mesh mesh;
  add_column(mesh, {0, 0, -0.3}, {0, 0, height}, 0.10, 0.06, 8, kSteel);
  add_column(mesh, {0, 0, height - 0.1}, {0, 1.6, height + 0.2}, 0.05, 0.04, 5, kSteel);
  add_box(mesh, kOrigin, {-0.15, 1.3, height + 0.1}, {0.15, 2.0, height + 0.28}, kSteel);
  return mesh;
}

Mesh make_sign(Rng& rng) {
  Mesh mesh;
  const double height = rng.uniform(2.2, 2.9);
  const double half = rng.uniform(0.25, 0.5);
  add_column(mesh, {0, 0, -0.3}, {0, 0, height}, 0.035, 0.035, 6, kSteel);
  add_box(mesh, kOrigin, {0.04, -half, height - 2.0 * half}, {0.06, half, height}, {Material::kSign, 128});
  return mesh;
}

Mesh make_bin(Rng& rng) {
  Mesh mesh;
  const double h = rng.uniform(0.8, 1.2);
  add_box(mesh, kOrigin, {-0.3, -0.3, 0.05}, {0.3, 0.3, h}, {Material::kPaint, 90});
  return mesh;
}

Mesh make_shelter() {
  Mesh mesh;
  add_box(mesh, kOrigin, {-1.9, -0.7, 2.3}, {1.9, 0.8, 2.42}, kSteel);
  add_box(mesh, kOrigin, {-1.9, 0.72, 0.2}, {1.9, 0.78, 2.3}, {Material::kGlass, 128});
  add_box(mesh, kOrigin, {-1.9, -0.6, 0.2}, {-1.85, 0.75, 2.3}, {Material::kSign, 128});
  add_box(mesh, kOrigin, {-1.2, 0.35, 0.42}, {1.2, 0.7, 0.5}, {Material::kWood, 128});
  return mesh;
}

Mesh make_guard_rail(double length) {
  Mesh mesh;
  add_box(mesh, kOrigin, {0, -0.05, 0.45}, {length, 0.03, 0.76}, kSteel);
  for (double x = 0.2; x < length; x += 2.0) {
    add_box(mesh, kOrigin, {x, 0.03, -0.3}, {x + 0.08, 0.12, 0.72}, kSteel);
  }
  return mesh;
}

class StreetFurnisher {
 public:
  StreetFurnisher(Builder& b, const RoadEdge& edge, std::uint64_t seed) : b_(b), edge_(edge), rng_(seed) {}

  void run() {
    if (edge_.zone == Zone::kOpen) {
      furnish_country();
      return;
    }
    const double tree_step = edge_.near_identical ? 11.0 : rng_.uniform() < 0.5 ? rng_.uniform(8.0, 15.0) : 0.0;
    for (const double side : {1.0, -1.0}) {
      const Frontage front(edge_, side);
      street_trees(front, tree_step);
      lamps(front);
      signs(front);
      clutter(front);
      parking(front);
    }
  }

 private:
  void put(const Frontage& front, double s, double offset, const Mesh& mesh) {
    const LinePoint p = front.at(s, offset);
    if (b_.plan.at(p.position) != GroundUse::kCarriageway && b_.plan.at(p.position) != GroundUse::kTaken) {
      // Turned so that +y of the part points to the street.
      b_.put(mesh, p.position, std::atan2(p.tangent.y(), p.tangent.x()) + (front.side > 0.0 ? std::numbers::pi : 0.0));
    }
  }

  void street_trees(const Frontage& front, double step) {
    if (step <= 0.0) {
      return;
    }
    const double height = rng_.uniform(6.0, 10.0);
    for (double s = 12.0; s < front.length - 11.0; s += step * rng_.uniform(0.9, 1.1)) {
      Rng plant(rng_.next());
      const double h = height * plant.uniform(0.8, 1.2);
      put(front, s, edge_.half_width_m + 0.7,
          make_tree({h, plant.uniform(1.4, 2.4), plant.uniform(0.1, 0.2), plant.uniform(2.2, 3.0), 320}, plant));
    }
  }

  void lamps(const Frontage& front) {
    const double step = rng_.uniform(24.0, 33.0);
    const double height = rng_.uniform(4.5, 8.0);
    for (double s = front.side > 0.0 ? 9.0 : 9.0 + 0.5 * step; s < front.length - 7.0; s += step) {
      put(front, s, edge_.half_width_m + 0.45, make_lamp(height));
    }
  }

  void signs(const Frontage& front) {
    put(front, front.length - 8.5, edge_.half_width_m + 0.4, make_sign(rng_));
    put(front, 8.0, edge_.half_width_m + 0.4, make_sign(rng_));
    if (rng_.uniform() < 0.5) {
      put(front, rng_.uniform(0.25, 0.75) * front.length, edge_.half_width_m + 0.4, make_sign(rng_));
    }
  }

  void clutter(const Frontage& front) {
    for (double s = 10.0; s < front.length - 8.0; s += rng_.uniform(7.0, 22.0)) {
      const double kind = rng_.uniform();
      const double offset = edge_.half_width_m + std::max(0.6, edge_.sidewalk_m - 0.4);
      if (kind < 0.6) {
        put(front, s, offset, make_bin(rng_));
      } else if (kind < 0.68) {
        put(front, s, edge_.half_width_m + 1.6, make_shelter());
      } else {
        Mesh cabinet;
        add_box(cabinet, kOrigin, {-0.5, -0.2, -0.1}, {0.5, 0.2, rng_.uniform(0.9, 1.4)}, {Material::kPaint, 160});
        put(front, s, offset, cabinet);
      }
    }
  }

  void parking(const Frontage& front) {
    if (edge_.half_width_m > 6.0 || edge_.zone == Zone::kCommercial) {
      return;
    }
    const double chance = rng_.uniform(0.25, 0.75);
    for (double s = 18.0; s < front.length - 17.0; s += rng_.uniform(5.6, 7.2)) {
      const LinePoint p = front.at(s, edge_.half_width_m - 1.02);
      const Eigen::Vector2d heading = front.side > 0.0 ? Eigen::Vector2d(-p.tangent) : p.tangent;
      const double z = b_.town.terrain.road(p.position) - kCamber * (edge_.half_width_m - 1.0);
      b_.town.parking.push_back(
          {pose_from_yaw(std::atan2(heading.y(), heading.x()), {p.position.x(), p.position.y(), z}), chance});
    }
  }

  void furnish_country() {
    for (const double side : {1.0, -1.0}) {
      const Frontage front(edge_, side);
      for (double s = 1.0; s + 4.0 < front.length; s += 4.0) {
        const LinePoint p = front.at(s, edge_.half_width_m + 0.6);
        const double river = b_.town.terrain.river_distance(p.position);
        if (river > 20.0 && river < 46.0) {
          put(front, side > 0.0 ? s + 4.0 : s, edge_.half_width_m + 0.6, make_guard_rail(4.0));
        }
      }
      for (double s = rng_.uniform(5.0, 50.0); s < front.length; s += rng_.uniform(50.0, 90.0)) {
        Mesh post;
        add_column(post, {0, 0, -0.2}, {0, 0, 1.0}, 0.06, 0.06, 5, {Material::kSign, 200});
        put(front, s, edge_.half_width_m + 1.0, post);
      }
    }
    const Frontage front(edge_, 1.0);
    for (double s = 20.0; s < front.length; s += rng_.uniform(60.0, 140.0)) {
      Rng plant(rng_.next());
      put(front, s, edge_.half_width_m + rng_.uniform(3.0, 20.0), make_tree({9.0, 2.8, 0.22, 2.2, 400}, plant));
    }
  }

  Builder& b_;
  const RoadEdge& edge_;
  Rng rng_;
};

}  // namespace

void furnish_street(Builder& b, const RoadEdge& edge, std::uint64_t seed) { StreetFurnisher(b, edge, seed).run(); }

void fill_free_ground(Builder& b, std::uint64_t seed) {
  Rng rng(seed);
  const auto& land = b.town.terrain.layout();
  const Eigen::Vector2d town_high(land.river_x - 25.0, land.high.y());
  const double area = (town_high - land.low).prod();
  const int attempts = static_cast<int>(area / 110.0);
  for (int i = 0; i < attempts; ++i) {
    const Eigen::Vector2d p(rng.uniform(land.low.x(), town_high.x()), rng.uniform(land.low.y(), town_high.y()));
    Rng plant(rng.next());
    if (!b.plan.is_free(p, 1.8)) {
      continue;
    }
    b.plan.mark_disc(p, 1.5, GroundUse::kTaken);
    const double kind = plant.uniform();
    if (kind < 0.45) {
      const double height = plant.uniform(4.0, 11.0);
      b.put(make_tree({height, 0.27 * height, 0.022 * height, 0.28 * height, 300}, plant), p, 0.0);
    } else if (kind < 0.8) {
      b.put(make_bush(plant.uniform(0.5, 1.5), plant.uniform(0.5, 2.2), plant), p, 0.0);
    } else {
      Mesh shed;
      const Eigen::Vector3d half(plant.uniform(1.0, 1.8), plant.uniform(0.8, 1.5), 0.0);
      add_box(shed, Pose::Identity(), {-half.x(), -half.y(), -0.5}, {half.x(), half.y(), plant.uniform(1.9, 2.6)},
              {Material::kWood, 128});
      b.put(shed, p, plant.uniform(0.0, std::numbers::pi));
    }
  }
}

}  // namespace loopmark::simulation::internal

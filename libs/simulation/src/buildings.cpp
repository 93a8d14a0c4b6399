// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "buildings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loopmark/core/random.hpp"

namespace loopmark::simulation::internal {
namespace {

Surface shaded(Material material, Rng& rng) { return {material, static_cast<std::uint8_t>(64 + rng.below(128))}; }

/// Draws one wall in its own frame: x along the wall, z up, y into the building.
class Wall {
 public:
  Wall(Mesh& mesh, const Pose& T_mesh_wall, const BuildingSpec& spec, double width, Surface wall, Rng& rng)
      : mesh_(mesh), frame_(T_mesh_wall), spec_(spec), width_(width), wall_(wall), rng_(rng) {}

  void plain() { panel(0.0, width_, -spec_.below, top()); }

  void with_windows(bool front) {
    panel(0.0, width_, -spec_.below, 0.0);
    const int door = front ? static_cast<int>(rng_.below(static_cast<std::uint32_t>(columns()))) : -1;
    for (int floor = 0; floor < spec_.floors; ++floor) {
      draw_floor(floor, front, door);
    }
    if (front && spec_.style.bay) {
      draw_bay();
    }
    draw_drain_pipe();
  }

 private:
  double top() const { return spec_.floors * spec_.floor_height; }
  int columns() const { return std::max(1, static_cast<int>(width_ / spec_.style.window_pitch)); }
  Eigen::Vector3d point(double x, double y, double z) const { return frame_ * Eigen::Vector3d(x, y, z); }

  void panel(double x0, double x1, double z0, double z1, double y = 0.0) {
    if (x1 - x0 > 1e-3 && z1 - z0 > 1e-3) {
      add_quad(mesh_, point(x0, y, z0), point(x1, y, z0), point(x1, y, z1), point(x0, y, z1), wall_);
    }
  }

  /// An opening set back by `recess`, with its four reveals.
  void opening(double x0, double x1, double z0, double z1, double recess, Surface back) {
    const double y = recess;
    add_quad(mesh_, point(x0, y, z0), point(x1, y, z0), point(x1, y, z1), point(x0, y, z1), back);
    add_quad(mesh_, point(x0, 0, z0), point(x0, y, z0), point(x0, y, z1), point(x0, 0, z1), wall_);
    add_quad(mesh_, point(x1, 0, z0), point(x1, y, z0), point(x1, y, z1), point(x1, 0, z1), wall_);
    add_quad(mesh_, point(x0, 0, z0), point(x1, 0, z0), point(x1, y, z0), point(x0, y, z0), wall_);
    add_quad(mesh_, point(x0, 0, z1), point(x1, 0, z1), point(x1, y, z1), point(x0, y, z1), wall_);
  }

  struct Hole {
    double half_width, low, high, recess;
    Surface back;
    bool open;
  };

  Hole choose_hole(int floor, int column, bool front, int door) {
    const FacadeStyle& style = spec_.style;
    const double sill = std::max(0.15, 0.5 * (spec_.floor_height - style.window_height));
    // Half of the panes have a curtain, a blind or a shutter behind them that sends the beam back.
    const Surface pane = rng_.uniform() < 0.5 ? shaded(Material::kGlass, rng_) : shaded(Material::kWood, rng_);
    if (floor == 0 && column == door) {
      return {0.6, 0.12, 2.25, 0.45, shaded(Material::kWood, rng_), true};
    }
    if (floor == 0 && front && style.shop_front) {
      return {0.42 * style.window_pitch, 0.35, 2.4, 0.3, shaded(Material::kGlass, rng_), true};
    }
    const bool blind_wall = !front && rng_.uniform() < 0.45;
    return {0.5 * style.window_width, sill, sill + style.window_height, style.recess, pane, !blind_wall};
  }

  void draw_floor(int floor, bool front, int door) {
    const double z0 = floor * spec_.floor_height;
    const double z1 = z0 + spec_.floor_height;
    const double pitch = width_ / columns();
    double done = 0.0;
    for (int column = 0; column < columns(); ++column) {
      const Hole hole = choose_hole(floor, column, front, door);
      if (!hole.open) {
        continue;
      }
      const double middle = (column + 0.5) * pitch;
      const double x0 = middle - hole.half_width;
      const double x1 = middle + hole.half_width;
      panel(done, x0, z0, z1);
      panel(x0, x1, z0, z0 + hole.low);
      panel(x0, x1, z0 + hole.high, z1);
      opening(x0, x1, z0 + hole.low, z0 + hole.high, hole.recess, hole.back);
      done = x1;
      draw_balcony(floor, column, front, middle, z0);
    }
    panel(done, width_, z0, z1);
    if (spec_.style.ledge > 0.0 && floor > 0) {
      add_box(mesh_, frame_, {0.0, -spec_.style.ledge, z0 - 0.12}, {width_, 0.0, z0 + 0.12}, wall_);
    }
  }

  void draw_balcony(int floor, int column, bool front, double middle, double z) {
    const int every = spec_.style.balcony_every;
    if (!front || every == 0 || floor == 0 || column % every != 0) {
      return;
    }
    const double half = 0.46 * spec_.style.window_pitch;
    const Surface rail = {Material::kMetal, 120};
    add_box(mesh_, frame_, {middle - half, -1.25, z - 0.12}, {middle + half, 0.0, z + 0.06}, wall_);
    add_box(mesh_, frame_, {middle - half, -1.25, z + 0.25}, {middle + half, -1.2, z + 1.0}, rail);
    add_box(mesh_, frame_, {middle - half, -1.25, z + 0.25}, {middle - half + 0.05, 0.0, z + 1.0}, rail);
    add_box(mesh_, frame_, {middle + half - 0.05, -1.25, z + 0.25}, {middle + half, 0.0, z + 1.0}, rail);
  }

  void draw_bay() {
    const double x0 = rng_.uniform(0.15, 0.45) * width_;
    const double x1 = x0 + std::min(3.0, 0.4 * width_);
    const double z1 = std::max(spec_.floor_height, (spec_.floors - 1) * spec_.floor_height);
    Extrusion bay;  // outline in the x-y plane of the wall, pushed up
    bay.outline = {{x0, 0.0}, {x0 + 0.5, -0.8}, {x1 - 0.5, -0.8}, {x1, 0.0}};
    bay.y0 = 0.0;
    bay.y1 = z1;
    Pose T_wall_bay = Pose::Identity();
    T_wall_bay.linear() << 1, 0, 0, 0, 0, 1, 0, 1, 0;
    add_extrusion(mesh_, frame_ * T_wall_bay, bay, wall_);
  }

  void draw_drain_pipe() {
    const double x = rng_.uniform() < 0.5 ? 0.25 : width_ - 0.25;
    add_column(mesh_, point(x, -0.08, 0.0), point(x, -0.08, top()), 0.05, 0.05, 5, {Material::kMetal, 110});
  }

  Mesh& mesh_;
  Pose frame_;
  const BuildingSpec& spec_;
  double width_;
  Surface wall_;
  Rng& rng_;
};

void add_flat_roof(Mesh& mesh, const BuildingSpec& s, double z, Surface wall, Rng& rng) {
  const Surface roof = {Material::kRoof, 100};
  const Pose origin = Pose::Identity();
  add_quad(mesh, {0, 0, z}, {s.width, 0, z}, {s.width, s.depth, z}, {0, s.depth, z}, roof);
  const double parapet = rng.uniform(0.3, 0.9);
  add_box(mesh, origin, {0, 0, z}, {s.width, 0.25, z + parapet}, wall);
  add_box(mesh, origin, {0, s.depth - 0.25, z}, {s.width, s.depth, z + parapet}, wall);
  add_box(mesh, origin, {0, 0, z}, {0.25, s.depth, z + parapet}, wall);
  add_box(mesh, origin, {s.width - 0.25, 0, z}, {s.width, s.depth, z + parapet}, wall);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d at(rng.uniform(0.1, 0.7) * s.width, rng.uniform(0.1, 0.7) * s.depth, z);
    const Eigen::Vector3d size(rng.uniform(0.8, 3.0), rng.uniform(0.8, 2.5), rng.uniform(0.6, 2.4));
    add_box(mesh, origin, at, at + size, {Material::kConcrete, 128});
  }
}

void add_gable_roof(Mesh& mesh, const BuildingSpec& s, double z, Surface wall, Rng& rng) {
  const Surface tiles = {Material::kRoof, static_cast<std::uint8_t>(60 + rng.below(120))};
  const double eaves = 0.45;
  const double rise = rng.uniform(0.55, 0.95) * 0.5 * s.depth;
  const double drop = eaves * rise / (0.5 * s.depth);
  const double mid = 0.5 * s.depth;
  add_quad(mesh, {-0.2, -eaves, z - drop}, {s.width + 0.2, -eaves, z - drop}, {s.width + 0.2, mid, z + rise},
           {-0.2, mid, z + rise}, tiles);
  add_quad(mesh, {-0.2, s.depth + eaves, z - drop}, {s.width + 0.2, s.depth + eaves, z - drop},
           {s.width + 0.2, mid, z + rise}, {-0.2, mid, z + rise}, tiles);
  add_triangle(mesh, {0, 0, z}, {0, s.depth, z}, {0, mid, z + rise}, wall);
  add_triangle(mesh, {s.width, 0, z}, {s.width, s.depth, z}, {s.width, mid, z + rise}, wall);
  const double x = rng.uniform(0.2, 0.8) * s.width;
  add_box(mesh, Pose::Identity(), {x, mid - 0.8, z}, {x + 0.7, mid - 0.1, z + rise + 0.9}, {Material::kBrick, 128});
  if (rng.uniform() < 0.4) {
    const double d = rng.uniform(0.2, 0.6) * s.width;
    add_box(mesh, Pose::Identity(), {d, 0.18 * s.depth, z}, {d + 1.8, mid, z + 0.75 * rise}, wall);
  }
}

}  // namespace

Mesh make_building(const BuildingSpec& spec) {
  Rng rng(spec.seed);
  Mesh mesh;
  const Surface wall = shaded(spec.style.wall, rng);
  const auto side = [&](double x, double y, double yaw, double width, bool front, bool joined) {
    Wall painter(mesh, pose_from_yaw(yaw, {x, y, 0.0}), spec, width, wall, rng);
    joined ? painter.plain() : painter.with_windows(front);
  };
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  side(0.0, 0.0, 0.0, spec.width, true, false);
  side(spec.width, 0.0, kQuarter, spec.depth, false, spec.joined_right);
  side(spec.width, spec.depth, 2.0 * kQuarter, spec.width, false, false);
  side(0.0, spec.depth, -kQuarter, spec.depth, false, spec.joined_left);
  const double top = spec.floors * spec.floor_height;
  spec.roof == Roof::kFlat ? add_flat_roof(mesh, spec, top, wall, rng) : add_gable_roof(mesh, spec, top, wall, rng);
  return mesh;
}

}  // namespace loopmark::simulation::internal

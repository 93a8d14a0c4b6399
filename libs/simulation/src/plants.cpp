// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "plants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace loopmark::simulation::internal {
namespace {

Eigen::Vector3d random_direction(Rng& rng) {
  Eigen::Vector3d d(rng.normal(), rng.normal(), rng.normal());
  return d.norm() > 1e-6 ? d.normalized() : Eigen::Vector3d::UnitZ();
}

void add_leaf(Mesh& mesh, const Eigen::Vector3d& at, double size, Rng& rng) {
  const Eigen::Vector3d u = size * random_direction(rng);
  const Eigen::Vector3d v = size * random_direction(rng);
  add_triangle(mesh, at - 0.5 * u, at + 0.5 * u, at + v, {Material::kLeaf, static_cast<std::uint8_t>(rng.below(256))});
}

/// Leaves in an ellipsoid, denser towards its shell.
void add_leaves(Mesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int count, double size,
                Rng& rng) {
  for (int i = 0; i < count; ++i) {
    const double depth = std::pow(rng.uniform(), 0.22);
    const Eigen::Vector3d at = centre + depth * radii.cwiseProduct(random_direction(rng));
    add_leaf(mesh, at, size * rng.uniform(0.6, 1.4), rng);
  }
}

}  // namespace

Mesh make_tree(const TreeSpec& spec, Rng& rng) {
  Mesh mesh;
  const Surface bark = {Material::kBark, static_cast<std::uint8_t>(rng.below(256))};
  const Eigen::Vector3d lean(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), 1.0);
  const Eigen::Vector3d fork = lean * (0.55 * (spec.crown_base + spec.height));
  add_column(mesh, {0, 0, -0.3}, fork, 1.15 * spec.trunk_radius, 0.6 * spec.trunk_radius, 7, bark);
  const Eigen::Vector3d centre = lean * (0.5 * (spec.crown_base + spec.height));
  const Eigen::Vector3d radii(spec.crown_radius, spec.crown_radius, 0.5 * (spec.height - spec.crown_base));
  for (int i = 0; i < 5; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + rng.uniform()) / 5.0;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), rng.uniform(0.4, 1.0));
    const Eigen::Vector3d foot = lean * rng.uniform(0.85 * spec.crown_base, 0.5 * (spec.crown_base + spec.height));
    add_column(mesh, foot, foot + 0.7 * spec.crown_radius * out, 0.4 * spec.trunk_radius, 0.03, 4, bark);
  }
  add_leaves(mesh, centre, radii, spec.leaves, 0.42, rng);
  return mesh;
}

Mesh make_bush(double radius, double height, Rng& rng) {
  Mesh mesh;
  const int leaves = std::max(30, static_cast<int>(110.0 * radius * height));
  add_leaves(mesh, {0, 0, 0.5 * height}, {radius, radius, 0.5 * height}, leaves, 0.26, rng);
  return mesh;
}

Mesh make_hedge(double length, double width, double height, Rng& rng) {
  Mesh mesh;
  const int steps = std::max(1, static_cast<int>(length / 0.45));
  const auto rib = [&](int step) {
    std::array<Eigen::Vector3d, 5> points;
    const double x = length * step / steps;
    const double half = 0.5 * width;
    const std::array<Eigen::Vector2d, 5> outline = {
        {{-half, -0.3}, {-half, 0.6 * height}, {0.0, height}, {half, 0.6 * height}, {half, -0.3}}};
    for (std::size_t i = 0; i < 5; ++i) {
      points[i] = {x, outline[i].x() + rng.uniform(-0.09, 0.09), outline[i].y() + rng.uniform(-0.07, 0.07)};
    }
    return points;
  };
  auto last = rib(0);
  const Surface leaf = {Material::kLeaf, 128};
  for (int step = 1; step <= steps; ++step) {
    const auto next = rib(step);
    for (std::size_t i = 0; i < 4; ++i) {
      add_quad(mesh, last[i], next[i], next[i + 1], last[i + 1], leaf);
    }
    last = next;
  }
  return mesh;
}

}  // namespace loopmark::simulation::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loopmark/core/random.hpp"

namespace loopmark::simulation {
namespace {

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

double lattice_value(std::uint64_t seed, std::int64_t x, std::int64_t y) {
  const std::uint64_t bits = task_seed(seed, {static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y)});
  return static_cast<double>(bits >> 11U) / 4503599627370496.0 - 1.0;
}

}  // namespace

double place_noise(std::uint64_t seed, const Eigen::Vector2d& p, double cell) {
  const Eigen::Vector2d g = p / cell;
  const double fx = std::floor(g.x());
  const double fy = std::floor(g.y());
  const auto x = static_cast<std::int64_t>(fx);
  const auto y = static_cast<std::int64_t>(fy);
  const double u = smooth_step(g.x() - fx);
  const double v = smooth_step(g.y() - fy);
  const double low = (1.0 - u) * lattice_value(seed, x, y) + u * lattice_value(seed, x + 1, y);
  const double high = (1.0 - u) * lattice_value(seed, x, y + 1) + u * lattice_value(seed, x + 1, y + 1);
  return (1.0 - v) * low + v * high;
}

Terrain::Terrain(std::uint64_t seed, const Layout& layout) : layout_(layout) {
  Rng rng(task_seed(seed, {1}));
  for (Wave& wave : waves_) {
    const double length = rng.uniform(180.0, 460.0);
    const double direction = rng.uniform(0.0, 2.0 * std::numbers::pi);
    wave.k = 2.0 * std::numbers::pi / length * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    wave.amplitude = rng.uniform(0.5, 1.0) * length / 100.0;
    wave.phase = rng.uniform(0.0, 2.0 * std::numbers::pi);
  }
  river_phase_ = rng.uniform(0.0, 2.0 * std::numbers::pi);
  double steepest = 1e-9;
  for (double x = layout.low.x(); x <= layout.high.x(); x += 6.0) {
    for (double y = layout.low.y(); y <= layout.high.y(); y += 6.0) {
      steepest = std::max(steepest, road_gradient({x, y}).norm());
    }
  }
  scale_ = 0.97 * layout.max_slope / steepest;
}

double Terrain::hills(const Eigen::Vector2d& p) const {
  double height = 0.0;
  for (const Wave& wave : waves_) {
    height += wave.amplitude * std::sin(wave.k.dot(p) + wave.phase);
  }
  double free = 1.0;
  for (const double y : layout_.level_rows_y) {
    free *= smooth_step((std::abs(p.y() - y) - 22.0) / 130.0);
  }
  return scale_ * free * height;
}

Eigen::Vector2d Terrain::road_gradient(const Eigen::Vector2d& p) const {
  constexpr double kStep = 0.5;
  const Eigen::Vector2d dx(kStep, 0.0);
  const Eigen::Vector2d dy(0.0, kStep);
  return {(hills(p + dx) - hills(p - dx)) / (2.0 * kStep), (hills(p + dy) - hills(p - dy)) / (2.0 * kStep)};
}

double Terrain::river_distance(const Eigen::Vector2d& p) const {
  return std::abs(p.x() - layout_.river_x - 9.0 * std::sin(p.y() / 70.0 + river_phase_));
}

double Terrain::river_depth(const Eigen::Vector2d& p) const {
  return 4.5 * smooth_step((17.0 - river_distance(p)) / 9.0);
}

}  // namespace loopmark::simulation

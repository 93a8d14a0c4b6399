// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace loopmark::simulation {

/// The lie of the land: long hills whose slope stays below a bound, level along the rows of alike blocks, and a
/// river bed that roads cross on bridges.
class Terrain {
 public:
  struct Layout {
    Eigen::Vector2d low = Eigen::Vector2d::Zero();   ///< corner of the land, metres
    Eigen::Vector2d high = Eigen::Vector2d::Ones();  ///< opposite corner
    std::vector<double> level_rows_y;                ///< streets along x that stay level
    double river_x = 1e9;                            ///< the river runs along y near this x
    double max_slope = 0.06;
  };

  Terrain() = default;
  Terrain(std::uint64_t seed, const Layout& layout);

  /// Height of the open ground at (x, y), the river bed included, metres.
  double ground(const Eigen::Vector2d& p) const { return hills(p) - river_depth(p); }
  /// Height that roads follow: as the ground, but level across the river.
  double road(const Eigen::Vector2d& p) const { return hills(p); }
  /// Gradient of road(), by central differences.
  Eigen::Vector2d road_gradient(const Eigen::Vector2d& p) const;
  /// Depth of the river bed below the land, metres; 0 away from it.
  double river_depth(const Eigen::Vector2d& p) const;
  /// Distance from the middle of the river, metres.
  double river_distance(const Eigen::Vector2d& p) const;
  const Layout& layout() const { return layout_; }

 private:
  struct Wave {
    Eigen::Vector2d k = Eigen::Vector2d::Zero();  ///< radians a metre
    double amplitude = 0.0;
    double phase = 0.0;
  };
  double hills(const Eigen::Vector2d& p) const;

  Layout layout_;
  std::array<Wave, 4> waves_{};
  double scale_ = 1.0;
  double river_phase_ = 0.0;
};

/// Smooth noise in [-1, 1] that depends on place and seed only; `cell` is its grain in metres.
double place_noise(std::uint64_t seed, const Eigen::Vector2d& p, double cell);

}  // namespace loopmark::simulation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace loopmark::simulation::internal {

enum class GroundUse : std::uint8_t { kFree, kCarriageway, kSidewalk, kWater, kTaken };

/// An upright rectangle on the ground: a corner, the unit direction of its width; depth is to the left of it.
struct Footprint {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double width = 1.0;
  double depth = 1.0;

  Eigen::Vector2d point(double u, double v) const {
    return corner + u * along + v * Eigen::Vector2d(-along.y(), along.x());
  }
};

/// A raster of who uses the ground, so that things do not stand in each other or in the road.
class GroundPlan {
 public:
  GroundPlan(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

  GroundUse at(const Eigen::Vector2d& p) const;
  /// Marks cells within `half_width` of a polyline; cells already used otherwise stay unless `over` is set.
  void mark_line(const std::vector<Eigen::Vector2d>& line, double half_width, GroundUse use, bool over);
  void mark_disc(const Eigen::Vector2d& centre, double radius, GroundUse use);
  void mark(const Footprint& area, GroundUse use);
  /// True where every cell of the area is free.
  bool is_free(const Footprint& area) const;
  bool is_free(const Eigen::Vector2d& centre, double radius) const;
  bool contains(const Eigen::Vector2d& p) const;

 private:
  std::size_t cell(const Eigen::Vector2d& p) const;

  Eigen::Vector2d low_;
  Eigen::Vector2i size_;
  std::vector<GroundUse> cells_;
};

}  // namespace loopmark::simulation::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ground_plan.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::simulation::internal {
namespace {

constexpr double kCell = 0.5;

template <class Visit>
bool all_cells(const Footprint& area, const Visit& visit) {
  const int nu = std::max(1, static_cast<int>(std::ceil(area.width / (0.8 * kCell))));
  const int nv = std::max(1, static_cast<int>(std::ceil(area.depth / (0.8 * kCell))));
  for (int i = 0; i <= nu; ++i) {
    for (int j = 0; j <= nv; ++j) {
      if (!visit(area.point(area.width * i / nu, area.depth * j / nv))) {
        return false;
      }
    }
  }
  return true;
}

template <class Visit>
bool all_in_disc(const Eigen::Vector2d& centre, double radius, const Visit& visit) {
  const int n = static_cast<int>(std::ceil(radius / kCell));
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      const Eigen::Vector2d offset(i * kCell, j * kCell);
      if (offset.norm() <= radius && !visit(Eigen::Vector2d(centre + offset))) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

GroundPlan::GroundPlan(const Eigen::Vector2d& low, const Eigen::Vector2d& high)
    : low_(low), size_(((high - low) / kCell).array().ceil().cast<int>() + 1) {
  cells_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()), GroundUse::kFree);
}

bool GroundPlan::contains(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d g = (p - low_) / kCell;
  return g.x() >= 0.0 && g.y() >= 0.0 && g.x() < size_.x() - 1.0 && g.y() < size_.y() - 1.0;
}

std::size_t GroundPlan::cell(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d g = (p - low_) / kCell;
  return static_cast<std::size_t>(g.y() + 0.5) * static_cast<std::size_t>(size_.x()) +
         static_cast<std::size_t>(g.x() + 0.5);
}

GroundUse GroundPlan::at(const Eigen::Vector2d& p) const { return contains(p) ? cells_[cell(p)] : GroundUse::kTaken; }

void GroundPlan::mark_disc(const Eigen::Vector2d& centre, double radius, GroundUse use) {
  all_in_disc(centre, radius, [&](const Eigen::Vector2d& p) {
    if (contains(p)) {
      cells_[cell(p)] = use;
    }
    return true;
  });
}

void GroundPlan::mark_line(const std::vector<Eigen::Vector2d>& line, double half_width, GroundUse use, bool over) {
  for (const Eigen::Vector2d& centre : line) {
    all_in_disc(centre, half_width, [&](const Eigen::Vector2d& p) {
      if (contains(p) && (over || cells_[cell(p)] == GroundUse::kFree)) {
        cells_[cell(p)] = use;
      }
      return true;
    });
  }
}

void GroundPlan::mark(const Footprint& area, GroundUse use) {
  all_cells(area, [&](const Eigen::Vector2d& p) {
    if (contains(p)) {
      cells_[cell(p)] = use;
    }
    return true;
  });
}

bool GroundPlan::is_free(const Footprint& area) const {
  return all_cells(area, [&](const Eigen::Vector2d& p) { return at(p) == GroundUse::kFree; });
}

bool GroundPlan::is_free(const Eigen::Vector2d& centre, double radius) const {
  return all_in_disc(centre, radius, [&](const Eigen::Vector2d& p) { return at(p) == GroundUse::kFree; });
}

}  // namespace loopmark::simulation::internal

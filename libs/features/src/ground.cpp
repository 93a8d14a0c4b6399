// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace loopmark::features {
namespace {

using Cell = std::pair<long, long>;

Cell cell_of(const Eigen::Vector3f& p, double size) {
  return {std::lround(std::floor(static_cast<double>(p.x()) / size)),
          std::lround(std::floor(static_cast<double>(p.y()) / size))};
}

/// The lowest z of each occupied cell, and then of the 3 x 3 cells around it.
std::map<Cell, float> floors_of(const std::vector<Eigen::Vector3f>& points, double size) {
  std::map<Cell, float> lowest;
  for (const Eigen::Vector3f& p : points) {
    if (p.allFinite()) {
      float& low = lowest.try_emplace(cell_of(p, size), p.z()).first->second;
      low = std::min(low, p.z());
    }
  }
  std::map<Cell, float> floors;
  for (const auto& [cell, own] : lowest) {
    float low = own;
    for (long dx = -1; dx <= 1; ++dx) {
      for (long dy = -1; dy <= 1; ++dy) {
        const auto found = lowest.find({cell.first + dx, cell.second + dy});
        low = found != lowest.end() ? std::min(low, found->second) : low;
      }
    }
    floors[cell] = low;
  }
  return floors;
}

}  // namespace

std::vector<bool> ground_points(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                                const GroundOptions& options) {
  check(options);
  const std::map<Cell, float> floors = floors_of(points, options.cell_m);
  std::vector<bool> ground(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      continue;
    }
    const double height = static_cast<double>(points[i].z() - floors.at(cell_of(points[i], options.cell_m)));
    const bool flat = !normals.empty() && static_cast<double>(std::abs(normals[i].z())) > options.flat_cosine;
    ground[i] = height < (flat ? options.flat_clearance_m : options.clearance_m);
  }
  return ground;
}

}  // namespace loopmark::features

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/ground_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace loopmark::bev {
namespace {

constexpr int kSide = GroundMap::kSide;
constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kRoughness = 0.25F;  // metres that the lowest point may stray from the slope

int cell_of(float metres) {
  return std::clamp(static_cast<int>(std::floor(metres / GroundMap::kCell)) + kSide / 2, 0, kSide - 1);
}

float centre_of(int cell) {
  constexpr int kMiddle = kSide / 2;
  return (static_cast<float>(cell - kMiddle) + 0.5F) * GroundMap::kCell;
}

/// The second lowest point of each cell (the lowest may be a stray return from below the ground).
std::vector<float> second_lowest(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> lowest(kSide * kSide, kNothing);
  std::vector<float> second(kSide * kSide, kNothing);
  for (const Eigen::Vector3f& p : points) {
    const auto cell = static_cast<std::size_t>(cell_of(p.y()) * kSide + cell_of(p.x()));
    if (p.z() < lowest[cell]) {
      second[cell] = lowest[cell];
      lowest[cell] = p.z();
    } else if (p.z() < second[cell]) {
      second[cell] = p.z();
    }
  }
  return second;
}

/// All cells, the nearest to the sensor first; ties in grid order.
std::vector<std::size_t> cells_outwards() {
  std::vector<std::size_t> cells(kSide * kSide);
  std::iota(cells.begin(), cells.end(), 0);
  const auto range = [](std::size_t cell) {
    const int x = static_cast<int>(cell) % kSide - kSide / 2;
    const int y = static_cast<int>(cell) / kSide - kSide / 2;
    return (2 * x + 1) * (2 * x + 1) + (2 * y + 1) * (2 * y + 1);
  };
  std::stable_sort(cells.begin(), cells.end(), [&](std::size_t a, std::size_t b) { return range(a) < range(b); });
  return cells;
}

}  // namespace

GroundMap::GroundMap(const std::vector<Eigen::Vector3f>& points) : GroundMap() {
  static const std::vector<std::size_t> outwards = cells_outwards();
  const std::vector<float> low = second_lowest(points);
  std::vector<float> reach(kSide * kSide, 0.0F);  // metres since ground was last seen
  for (const std::size_t cell : outwards) {
    const int ix = static_cast<int>(cell) % kSide;
    const int iy = static_cast<int>(cell) / kSide;
    const float x = centre_of(ix);
    const float y = centre_of(iy);
    const float range = std::hypot(x, y);
    if (range < 2.0F * kCell) {
      seen_[cell] = 1;
      continue;  // the levelled plane itself
    }
    const float shrink = (range - kCell) / range;
    const auto parent = static_cast<std::size_t>(cell_of(y * shrink) * kSide + cell_of(x * shrink));
    const float expected = ground_[parent];
    const float tolerance = kRoughness + kSlope * (kCell + reach[parent]);
    const bool seen = std::abs(low[cell] - expected) < tolerance;
    seen_[cell] = seen ? 1 : 0;
    ground_[cell] = seen ? low[cell] : expected;
    reach[cell] = seen ? 0.0F : std::min(reach[parent] + kCell, 10.0F);
  }
}

bool GroundMap::seen(float x, float y) const {
  return seen_[static_cast<std::size_t>(cell_of(y) * kSide + cell_of(x))] != 0;
}

float GroundMap::ground(float x, float y) const {
  const float gx = std::clamp(x / kCell + static_cast<float>(kSide) / 2.0F - 0.5F, 0.0F, kSide - 1.001F);
  const float gy = std::clamp(y / kCell + static_cast<float>(kSide) / 2.0F - 0.5F, 0.0F, kSide - 1.001F);
  const int ix = static_cast<int>(gx);
  const int iy = static_cast<int>(gy);
  const float ax = gx - static_cast<float>(ix);
  const float ay = gy - static_cast<float>(iy);
  const float* row = ground_.data() + static_cast<std::size_t>(iy * kSide + ix);
  return (1.0F - ay) * ((1.0F - ax) * row[0] + ax * row[1]) + ay * ((1.0F - ax) * row[kSide] + ax * row[kSide + 1]);
}

}  // namespace loopmark::bev

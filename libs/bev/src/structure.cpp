// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/structure.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::bev {
namespace {

/// The bit of the height band, or 0.
std::uint8_t band_of(float height) {
  if (height < kBandEdges.front() || height >= kBandEdges.back()) {
    return 0;
  }
  unsigned band = 0;
  while (height >= kBandEdges[band + 1]) {
    ++band;
  }
  return static_cast<std::uint8_t>(1U << band);
}

constexpr float kGroundBand = 0.35F;   // metres to either side of the ground map
constexpr float kReliefReach = 60.0F;  // metres from the sensor; beyond it rings stand too far apart
constexpr int kReliefSide = 256;       // cells of kStructureCell a side

/// Sums over the ground points of a grid of cells, so that the mean over any square takes four look-ups.
class GroundSums {
 public:
  GroundSums() : count_(kSide * kSide, 0.0), height_(kSide * kSide, 0.0) {}

  void add(int column, int row, double height) {
    count_[at(column, row)] += 1.0;
    height_[at(column, row)] += height;
  }

  void integrate() {
    for (std::vector<double>* sums : {&count_, &height_}) {
      for (int row = 1; row < kSide; ++row) {
        double line = 0.0;
        for (int column = 1; column < kSide; ++column) {
          line += (*sums)[at(column, row)];
          (*sums)[at(column, row)] = line + (*sums)[at(column, row - 1)];
        }
      }
    }
  }

  /// Mean height of the ground within `radius` cells.
  double mean(int column, int row, int radius) const {
    const int x0 = std::max(0, column - radius - 1);
    const int y0 = std::max(0, row - radius - 1);
    const int x1 = std::min(kSide - 1, column + radius);
    const int y1 = std::min(kSide - 1, row + radius);
    const auto sum = [&](const std::vector<double>& s) {
      return s[at(x1, y1)] - s[at(x0, y1)] - s[at(x1, y0)] + s[at(x0, y0)];
    };
    return sum(height_) / std::max(1.0, sum(count_));
  }

 private:
  static constexpr int kSide = kReliefSide + 1;  // row and column 0 stay empty
  static std::size_t at(int column, int row) { return static_cast<std::size_t>(row * kSide + column); }

  std::vector<double> count_;
  std::vector<double> height_;
};

}  // namespace

std::vector<StructureCell> structure_cells(const std::vector<Eigen::Vector3f>& points, const GroundMap& ground) {
  search::VoxelTable table(points.size() / 4);
  std::vector<StructureCell> cells;
  for (const Eigen::Vector3f& p : points) {
    const std::uint8_t band = band_of(ground.height_above(p));
    if (band == 0) {
      continue;
    }
    const auto column = static_cast<std::int32_t>(std::floor(p.x() / kStructureCell));
    const auto row = static_cast<std::int32_t>(std::floor(p.y() / kStructureCell));
    const std::uint32_t cell = table.insert({column, row, 0});
    if (cell == cells.size()) {
      cells.push_back(
          {(static_cast<float>(column) + 0.5F) * kStructureCell, (static_cast<float>(row) + 0.5F) * kStructureCell, 0});
    }
    cells[cell].bands |= band;
  }
  return cells;
}

std::vector<ReliefCell> relief_cells(const std::vector<Eigen::Vector3f>& points, const GroundMap& ground) {
  GroundSums sums;
  search::VoxelTable table(points.size() / 2);
  std::vector<std::pair<float, float>> cells;  // count and sum of heights
  for (const Eigen::Vector3f& p : points) {
    if (p.head<2>().norm() > kReliefReach || std::abs(ground.height_above(p)) > kGroundBand) {
      continue;
    }
    const auto column = static_cast<std::int32_t>(std::floor(p.x() / kStructureCell));
    const auto row = static_cast<std::int32_t>(std::floor(p.y() / kStructureCell));
    sums.add(column + kReliefSide / 2 + 1, row + kReliefSide / 2 + 1, static_cast<double>(p.z()));
    const std::uint32_t cell = table.insert({column, row, 0});
    cells.resize(table.size());
    cells[cell].first += 1.0F;
    cells[cell].second += p.z();
  }
  sums.integrate();
  constexpr int kRadius = static_cast<int>(kReliefRadius / kStructureCell);
  std::vector<ReliefCell> relief;
  relief.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const search::Voxel& v = table.voxels()[i];
    const auto around = static_cast<float>(sums.mean(v.x + kReliefSide / 2 + 1, v.y + kReliefSide / 2 + 1, kRadius));
    relief.push_back({(static_cast<float>(v.x) + 0.5F) * kStructureCell,
                      (static_cast<float>(v.y) + 0.5F) * kStructureCell,
                      std::clamp(cells[i].second / cells[i].first - around, -kMostRelief, kMostRelief)});
  }
  return relief;
}

}  // namespace loopmark::bev

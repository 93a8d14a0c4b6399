// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace loopmark::search {

/// Points sorted into cubic cells, for many searches within a known small distance (descriptors, ICP). Points of
/// a cell, and cells that follow each other along x, lie side by side in memory, each coordinate for itself, so
/// that a search scans a few contiguous runs. Points that are not finite are in no cell.
class CellGrid {
 public:
  /// Sorted places [begin, end): see x(), y(), z() and index().
  struct Run {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  /// One occupied cell: its integer coordinates and its points.
  struct Cell {
    std::array<std::int32_t, 3> at{};
    Run run;
  };
  struct Nearest {
    std::uint32_t place = 0;  ///< in the sorted order
    float squared_distance = 0.0F;
  };

  /// Throws std::invalid_argument unless cell_m > 0 and the points span fewer than 2^20 cells along each axis.
  CellGrid(const std::vector<Eigen::Vector3f>& points, float cell_m);

  std::size_t size() const { return index_.size(); }
  float cell_m() const { return cell_m_; }
  /// Coordinates (metres) and original index of the points, by sorted place.
  const std::vector<float>& x() const { return x_; }
  const std::vector<float>& y() const { return y_; }
  const std::vector<float>& z() const { return z_; }
  const std::vector<std::uint32_t>& index() const { return index_; }
  const std::vector<Cell>& cells() const { return cells_; }
  Eigen::Vector3f point(std::uint32_t place) const { return {x_[place], y_[place], z_[place]}; }

  /// The runs of the 27 cells around a cell of the grid, empty ones left out: all within cell_m of its points.
  void runs_around(const Cell& cell, std::vector<Run>& runs) const;

  /// The nearest point closer than sqrt(max_squared), the one of the lowest original index among equals.
  /// Cost grows with (max distance / cell_m)^2; a cell of twice the distance is a good choice.
  std::optional<Nearest> nearest(const Eigen::Vector3f& query, float max_squared) const;

  /// Calls visit(place, squared_distance) for every point closer than `radius`.
  template <class Visit>
  void within(const Eigen::Vector3f& query, float radius, const Visit& visit) const {
    const float squared = radius * radius;
    for_each_run(query, radius, [&](Run run, float) {
      for (std::uint32_t i = run.begin; i < run.end; ++i) {
        const float d = squared_distance(query, i);
        if (d < squared) {
          visit(i, d);
        }
      }
      return squared;
    });
  }

 private:
  static constexpr std::int32_t kLimit = 1 << 20;

  std::int32_t coordinate(float value) const;
  /// Number of the cell, or -1.
  std::int32_t find(std::int32_t cx, std::int32_t cy, std::int32_t cz) const;
  Run row(std::int32_t x0, std::int32_t x1, std::int32_t cy, std::int32_t cz) const;
  void index_cells();
  float squared_distance(const Eigen::Vector3f& q, std::uint32_t i) const {
    const float dx = x_[i] - q.x();
    const float dy = y_[i] - q.y();
    const float dz = z_[i] - q.z();
    return dx * dx + dy * dy + dz * dz;
  }
  float row_gap(float q, std::int32_t c) const {
    const float low = static_cast<float>(c) * cell_m_ - q;
    const float high = q - static_cast<float>(c + 1) * cell_m_;
    return std::max(0.0F, std::max(low, high));
  }

  /// visit(run, squared distance to the row) -> the squared distance still of interest.
  template <class Visit>
  void for_each_run(const Eigen::Vector3f& q, float radius, const Visit& visit) const {
    if (!q.allFinite() || size() == 0) {
      return;
    }
    const float reach = radius * 1.0001F;
    const Eigen::Vector3f low = q.array() - reach;
    const Eigen::Vector3f high = q.array() + reach;
    const std::int32_t x0 = coordinate(low.x());
    const std::int32_t x1 = coordinate(high.x());
    float limit = radius * radius;
    for (std::int32_t cz = coordinate(low.z()); cz <= coordinate(high.z()); ++cz) {
      const float gz = row_gap(q.z(), cz);
      for (std::int32_t cy = coordinate(low.y()); cy <= coordinate(high.y()); ++cy) {
        const float gy = row_gap(q.y(), cy);
        const float gap = (gy * gy + gz * gz) * 0.9999F;
        if (gap <= limit) {
          limit = visit(row(x0, x1, cy, cz), gap);
        }
      }
    }
  }

  float cell_m_ = 1.0F;
  std::vector<float> x_, y_, z_;
  std::vector<std::uint32_t> index_;
  std::vector<Cell> cells_;
  std::vector<std::int32_t> table_;  ///< open addressing: cell number or -1
};

}  // namespace loopmark::search

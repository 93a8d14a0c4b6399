// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/search/cell_grid.hpp"
#include "normal_kernels.hpp"

namespace loopmark::features::internal {

/// The points of the 27 cells around a cell, copied side by side and filled up to whole lanes: what all the points of
/// the cell have to look at.
struct Neighbourhood {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> place;  ///< in the grid; only `count` of them
  std::size_t count = 0;

  void gather(const search::CellGrid& grid, const search::CellGrid::Cell& cell) {
    grid.runs_around(cell, runs_);
    count = 0;
    for (const search::CellGrid::Run& run : runs_) {
      count += run.end - run.begin;
    }
    const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
    x.assign(padded, kFarAway);
    y.assign(padded, kFarAway);
    z.assign(padded, kFarAway);
    place.resize(count);
    std::size_t k = 0;
    for (const search::CellGrid::Run& run : runs_) {
      for (std::uint32_t i = run.begin; i < run.end; ++i, ++k) {
        x[k] = grid.x()[i];
        y[k] = grid.y()[i];
        z[k] = grid.z()[i];
        place[k] = i;
      }
    }
  }

 private:
  std::vector<search::CellGrid::Run> runs_;
};

}  // namespace loopmark::features::internal

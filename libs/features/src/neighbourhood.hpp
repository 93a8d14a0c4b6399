// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/search/cell_grid.hpp"
#include "normal_kernels.hpp"

namespace loopmark {

/// The points of the 27 cells around a cell, copied side by side and filled up to whole lanes: what all the points of
/// the cell have to look at.
struct Neighbourhood {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> place;  ///< in the grid; only `count` of them
  std::size_t count = 0;

  void gather(const CellGrid& grid, const CellGrid::Cell& cell) {
    grid.runs_around(cell, runs_);
    count = 0;
    for (const CellGrid::Run& run : runs_) {
      count += run.end - run.begin;
    }
    const std::size_t padded = (count + kernels::kLanes - 1) / kernels::kLanes * kernels::kLanes;
    x.assign(padded, kernels::kFarAway);
    y.assign(padded, kernels::kFarAway);
    z.assign(padded, kernels::kFarAway);
    place.resize(count);
    std::size_t k = 0;
    for (const CellGrid::Run& run : runs_) {
      for (std::uint32_t i = run.begin; i < run.end; ++i, ++k) {
        x[k] = grid.x()[i];
        y[k] = grid.y()[i];
        z[k] = grid.z()[i];
        place[k] = i;
      }
    }
  }

 private:
  std::vector<CellGrid::Run> runs_;
};

}  // namespace loopmark

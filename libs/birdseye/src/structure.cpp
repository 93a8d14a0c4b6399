// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/birdseye/structure.hpp"

#include <cmath>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::birdseye {
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

}  // namespace

std::vector<StructureCell> structure_cells(const std::vector<Eigen::Vector3f>& points, const GroundMap& ground) {
  VoxelTable table(points.size() / 4);
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

}  // namespace loopmark::birdseye

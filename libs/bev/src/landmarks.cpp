// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/landmarks.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::bev {
namespace {

constexpr int kReach = 2;  // cells

/// Cells that touch a seed's, and so on: their indices. Cells up to kReach apart touch.
std::vector<std::size_t> group_of(std::size_t seed, const search::VoxelTable& table, std::vector<bool>& taken) {
  std::vector<std::size_t> group = {seed};
  taken[seed] = true;
  for (std::size_t next = 0; next < group.size(); ++next) {
    const search::Voxel& v = table.voxels()[group[next]];
    for (int dx = -kReach; dx <= kReach; ++dx) {
      for (int dy = -kReach; dy <= kReach; ++dy) {
        const std::uint32_t i = table.find({v.x + dx, v.y + dy, 0});
        if (i != search::VoxelTable::kNone && !taken[i]) {
          taken[i] = true;
          group.push_back(i);
        }
      }
    }
  }
  return group;
}

/// The middle of a group, unless it is too wide.
std::optional<Landmark> landmark_of(const std::vector<std::size_t>& group, const std::vector<StructureCell>& cells) {
  Eigen::Array2f low = Eigen::Array2f::Constant(std::numeric_limits<float>::max());
  Eigen::Array2f high = -low;
  Eigen::Array2f sum = Eigen::Array2f::Zero();
  unsigned bands = 0;
  for (const std::size_t i : group) {
    const Eigen::Array2f p(cells[i].x, cells[i].y);
    low = low.min(p);
    high = high.max(p);
    sum += p;
    bands |= cells[i].bands;
  }
  if ((high - low).maxCoeff() > kLandmarkWidth) {
    return std::nullopt;
  }
  const Eigen::Array2f middle = sum / static_cast<float>(group.size());
  return Landmark{middle.x(), middle.y(), bands > 1U};
}

}  // namespace

std::vector<Landmark> find_landmarks(const std::vector<StructureCell>& cells) {
  search::VoxelTable table(2 * cells.size());
  for (const StructureCell& cell : cells) {  // one entry each: structure_cells gives no cell twice
    table.insert(search::voxel_of({cell.x, cell.y, 0.0F}, 1.0F / kStructureCell));
  }
  std::vector<Landmark> landmarks;
  std::vector<bool> taken(table.size(), false);
  for (std::size_t seed = 0; seed < taken.size(); ++seed) {
    if (taken[seed]) {
      continue;
    }
    if (const auto landmark = landmark_of(group_of(seed, table, taken), cells)) {
      landmarks.push_back(*landmark);
    }
  }
  const auto order = [](const Landmark& l) { return std::make_tuple(!l.tall, l.x * l.x + l.y * l.y); };
  std::stable_sort(landmarks.begin(), landmarks.end(),
                   [&](const Landmark& a, const Landmark& b) { return order(a) < order(b); });
  landmarks.resize(std::min(landmarks.size(), kMostLandmarks));
  return landmarks;
}

}  // namespace loopmark::bev

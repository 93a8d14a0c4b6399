// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/search/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace loopmark::search {
namespace {

std::uint64_t key_of(std::int32_t cx, std::int32_t cy, std::int32_t cz, std::int32_t limit) {
  const auto part = [limit](std::int32_t c) { return static_cast<std::uint64_t>(c + limit); };
  return part(cz) << 42U | part(cy) << 21U | part(cx);
}

std::size_t hash_of(std::uint64_t key) {
  key *= 0x9E3779B97F4A7C15ULL;
  return static_cast<std::size_t>(key ^ (key >> 32U));
}

}  // namespace

CellGrid::CellGrid(const std::vector<Eigen::Vector3f>& points, float cell_m) : cell_m_(cell_m) {
  if (!(cell_m > 0.0F)) {
    throw std::invalid_argument("CellGrid: the cell must be larger than 0");
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
  keyed.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      continue;
    }
    if (points[i].cwiseAbs().maxCoeff() / cell_m >= static_cast<float>(kLimit - 2)) {
      throw std::invalid_argument("CellGrid: points too far from the origin for this cell");
    }
    keyed.emplace_back(key_of(coordinate(points[i].x()), coordinate(points[i].y()), coordinate(points[i].z()), kLimit),
                       static_cast<std::uint32_t>(i));
  }
  std::sort(keyed.begin(), keyed.end());
  x_.reserve(keyed.size());
  y_.reserve(keyed.size());
  z_.reserve(keyed.size());
  index_.reserve(keyed.size());
  for (std::size_t k = 0; k < keyed.size(); ++k) {
    const Eigen::Vector3f& p = points[keyed[k].second];
    if (k == 0 || keyed[k].first != keyed[k - 1].first) {
      const auto begin = static_cast<std::uint32_t>(k);
      cells_.push_back({{coordinate(p.x()), coordinate(p.y()), coordinate(p.z())}, {begin, begin}});
    }
    cells_.back().run.end = static_cast<std::uint32_t>(k + 1);
    x_.push_back(p.x());
    y_.push_back(p.y());
    z_.push_back(p.z());
    index_.push_back(keyed[k].second);
  }
  index_cells();
}

void CellGrid::index_cells() {
  std::size_t slots = 16;
  while (slots < 3 * cells_.size()) {
    slots *= 2;
  }
  table_.assign(slots, -1);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto& at = cells_[c].at;
    std::size_t slot = hash_of(key_of(at[0], at[1], at[2], kLimit)) & (slots - 1);
    while (table_[slot] >= 0) {
      slot = (slot + 1) & (slots - 1);
    }
    table_[slot] = static_cast<std::int32_t>(c);
  }
}

std::int32_t CellGrid::coordinate(float value) const {
  const float cell = std::floor(value / cell_m_);
  const auto limit = static_cast<float>(kLimit - 1);
  return static_cast<std::int32_t>(std::clamp(cell, -limit, limit));
}

std::int32_t CellGrid::find(std::int32_t cx, std::int32_t cy, std::int32_t cz) const {
  const std::array<std::int32_t, 3> wanted{cx, cy, cz};
  std::size_t slot = hash_of(key_of(cx, cy, cz, kLimit)) & (table_.size() - 1);
  while (table_[slot] >= 0 && cells_[static_cast<std::size_t>(table_[slot])].at != wanted) {
    slot = (slot + 1) & (table_.size() - 1);
  }
  return table_[slot];
}

CellGrid::Run CellGrid::row(std::int32_t x0, std::int32_t x1, std::int32_t cy, std::int32_t cz) const {
  Run run;
  for (std::int32_t cx = x0; cx <= x1; ++cx) {
    const std::int32_t c = find(cx, cy, cz);
    if (c < 0) {
      continue;
    }
    const Run& found = cells_[static_cast<std::size_t>(c)].run;
    run.begin = run.end == 0 ? found.begin : run.begin;
    run.end = found.end;
  }
  return run;
}

void CellGrid::runs_around(const Cell& cell, std::vector<Run>& runs) const {
  runs.clear();
  for (std::int32_t dz = -1; dz <= 1; ++dz) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      const Run run = row(cell.at[0] - 1, cell.at[0] + 1, cell.at[1] + dy, cell.at[2] + dz);
      if (run.end > run.begin) {
        runs.push_back(run);
      }
    }
  }
}

std::optional<CellGrid::Nearest> CellGrid::nearest(const Eigen::Vector3f& query, float max_squared) const {
  Nearest best{0, max_squared};
  bool found = false;
  for_each_run(query, std::sqrt(max_squared), [&](Run run, float) {
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const float d = squared_distance(query, i);
      if (d < best.squared_distance || (found && d == best.squared_distance && index_[i] < index_[best.place])) {
        best = {i, d};
        found = true;
      }
    }
    return best.squared_distance;
  });
  return found ? std::optional<Nearest>(best) : std::nullopt;
}

}  // namespace loopmark::search

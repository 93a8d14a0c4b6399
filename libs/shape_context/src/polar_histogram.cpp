// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "polar_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::shape_context::internal {
namespace {

/// Points of one band that stand above one another.
struct Column {
  double x = 0.0;
  double y = 0.0;
  double voxels = 0.0;
  std::uint8_t band = 0;
};

std::vector<Column> columns_of(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& heights) {
  constexpr float kPerMetre = 1.0F / StructureColumns::kColumn;
  search::VoxelTable voxels(points.size() / 2);
  search::VoxelTable table(points.size() / 4);
  std::vector<Column> columns;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(heights[i] >= kBandFrom.front())) {
      continue;
    }
    const std::size_t known = voxels.size();
    const search::Voxel voxel = search::voxel_of(points[i], kPerMetre);
    if (voxels.insert(voxel) != known) {
      continue;
    }
    const auto above = std::upper_bound(kBandFrom.begin(), kBandFrom.end(), heights[i]);
    const auto band = static_cast<std::int32_t>(above - kBandFrom.begin()) - 1;
    const std::uint32_t c = table.insert({voxel.x, voxel.y, band});
    columns.resize(table.size());
    columns[c].x += static_cast<double>(points[i].x());
    columns[c].y += static_cast<double>(points[i].y());
    columns[c].voxels += 1.0;
    columns[c].band = static_cast<std::uint8_t>(band);
  }
  for (Column& c : columns) {
    c.x /= c.voxels;
    c.y /= c.voxels;
  }
  return columns;
}

/// Rows and columns with a margin: what lies inside the first and beyond the last ring, and the first sector again
/// behind the last, so that spreading needs no conditions.
constexpr std::size_t kRow = kSectors + 4;
using Margins = std::array<std::array<std::array<float, kRow>, kRings + 2>, kBands>;

/// What lies inside the first ring has no direction: it goes to all sectors alike.
PolarHistogram without_margins(const Margins& bins) {
  PolarHistogram out;
  for (std::size_t b = 0; b < kBands; ++b) {
    for (std::size_t r = 0; r < kRings; ++r) {
      std::copy_n(bins[b][r + 1].begin(), kSectors, out[b][r].begin());
      out[b][r][0] += bins[b][r + 1][kSectors];
    }
    const float inside = std::accumulate(bins[b][0].begin(), bins[b][0].end(), 0.0F) / static_cast<float>(kSectors);
    for (float& bin : out[b][0]) {
      bin += inside;
    }
  }
  return out;
}

}  // namespace

struct StructureColumns::Workspace {
  std::vector<float> dx, dy, weight, ring, sector;
  std::vector<std::uint8_t> band;
};

StructureColumns::StructureColumns(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& heights) {
  const std::vector<Column> columns = columns_of(points, heights);
  if (columns.empty()) {
    return;
  }
  const auto [west, east] =
      std::minmax_element(columns.begin(), columns.end(), [](const Column& a, const Column& b) { return a.x < b.x; });
  const auto [south, north] =
      std::minmax_element(columns.begin(), columns.end(), [](const Column& a, const Column& b) { return a.y < b.y; });
  x0_ = static_cast<float>(west->x);
  y0_ = static_cast<float>(south->y);
  width_ = static_cast<int>((static_cast<float>(east->x) - x0_) / kCell) + 1;
  height_ = static_cast<int>((static_cast<float>(north->y) - y0_) / kCell) + 1;
  const auto cell_of = [&](const Column& c) {
    const int ix = std::clamp(static_cast<int>((static_cast<float>(c.x) - x0_) / kCell), 0, width_ - 1);
    const int iy = std::clamp(static_cast<int>((static_cast<float>(c.y) - y0_) / kCell), 0, height_ - 1);
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(ix);
  };
  first_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, 0);
  for (const Column& c : columns) {
    ++first_[cell_of(c) + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::vector<float>* numbers : {&x_, &y_, &weight_}) {
    numbers->resize(columns.size());
  }
  band_.resize(columns.size());
  for (const Column& c : columns) {
    const std::uint32_t at = next[cell_of(c)]++;
    x_[at] = static_cast<float>(c.x);
    y_[at] = static_cast<float>(c.y);
    weight_[at] = static_cast<float>(c.voxels);
    band_[at] = c.band;
  }
}

void StructureColumns::gather(float x, float y, float radius, Workspace& work) const {
  for (std::vector<float>* numbers : {&work.dx, &work.dy, &work.weight}) {
    numbers->clear();
  }
  work.band.clear();
  const auto cell = [](float metres, int count) {
    return std::clamp(static_cast<int>(std::floor(metres / kCell)), 0, count - 1);
  };
  const int from_x = cell(x - radius - x0_, width_);
  const int to_x = cell(x + radius - x0_, width_);
  for (int iy = cell(y - radius - y0_, height_); iy <= cell(y + radius - y0_, height_); ++iy) {
    const std::size_t row = static_cast<std::size_t>(iy) * static_cast<std::size_t>(width_);
    const std::uint32_t end = first_[row + static_cast<std::size_t>(to_x) + 1];
    for (std::uint32_t i = first_[row + static_cast<std::size_t>(from_x)]; i < end; ++i) {
      const float dx = x_[i] - x;
      const float dy = y_[i] - y;
      if (dx * dx + dy * dy < radius * radius) {
        work.dx.push_back(dx);
        work.dy.push_back(dy);
        work.weight.push_back(weight_[i]);
        work.band.push_back(band_[i]);
      }
    }
  }
}

PolarHistogram StructureColumns::around(float x, float y, float radius) const {
  Margins bins{};
  if (size() > 0) {
    thread_local Workspace work;
    gather(x, y, radius, work);
    work.ring.resize(work.dx.size());
    work.sector.resize(work.dx.size());
    polar_places(work.dx.data(), work.dy.data(), work.dx.size(), radius, work.ring.data(), work.sector.data());
    for (std::size_t i = 0; i < work.dx.size(); ++i) {
      const auto ring = static_cast<std::size_t>(work.ring[i]);
      const auto sector = static_cast<std::size_t>(work.sector[i]);
      const float outer = (work.ring[i] - static_cast<float>(ring)) * work.weight[i];
      const float inner = work.weight[i] - outer;
      const float later = work.sector[i] - static_cast<float>(sector);
      float* near = bins[work.band[i]][ring].data() + sector;
      float* far = bins[work.band[i]][ring + 1].data() + sector;
      near[0] += inner * (1.0F - later);
      near[1] += inner * later;
      far[0] += outer * (1.0F - later);
      far[1] += outer * later;
    }
  }
  return without_margins(bins);
}

}  // namespace loopmark::shape_context::internal

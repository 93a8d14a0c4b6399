// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/fpfh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "fpfh_kernels.hpp"
#include "loopmark/core/parallel.hpp"
#include "neighbourhood.hpp"

namespace loopmark::features {
namespace {

using internal::kFpfhBins;
using internal::kFpfhRow;
using internal::kLanes;

constexpr std::size_t kCellsPerTask = 16;

/// Neighbours of the points of one task, one list after the other.
struct NeighbourLists {
  std::vector<std::uint32_t> place;
  std::vector<float> squared;
  std::vector<std::size_t> end;  ///< where each point's list ends
};

/// Reused memory of one task.
struct Workspace {
  internal::Neighbourhood around;
  std::vector<float> squared;                ///< of the candidates
  std::array<std::vector<float>, 7> arrays;  ///< x y z nx ny nz d2 of the neighbours
  std::array<std::vector<std::uint8_t>, 3> bins;
  void resize(std::size_t count) {
    const std::size_t padded = (count + internal::kLanes) / internal::kLanes * internal::kLanes;
    squared.resize(padded);
    for (auto& array : arrays) {
      array.resize(padded, 1.0F);
    }
    for (auto& b : bins) {
      b.resize(padded);
    }
  }
};

/// Points and normals in the order of the grid.
struct Cloud {
  const search::CellGrid& grid;
  std::vector<float> nx, ny, nz;

  Cloud(const search::CellGrid& cells, const std::vector<Eigen::Vector3f>& normals) : grid(cells) {
    for (const std::uint32_t i : grid.index()) {
      nx.push_back(normals[i].x());
      ny.push_back(normals[i].y());
      nz.push_back(normals[i].z());
    }
  }
};

/// Copies the candidates within the radius, the point itself left out, side by side; returns their number.
std::size_t pick_neighbours(const Cloud& cloud, std::uint32_t i, float squared_radius, Workspace& work,
                            NeighbourLists& lists) {
  const float q[3] = {cloud.grid.x()[i], cloud.grid.y()[i], cloud.grid.z()[i]};
  const internal::Neighbourhood& around = work.around;
  internal::squared_distances(around.x.data(), around.y.data(), around.z.data(), around.x.size(), q,
                              work.squared.data());
  const std::size_t first = lists.place.size();
  lists.place.resize(first + around.count);
  lists.squared.resize(first + around.count);
  std::uint32_t* place = lists.place.data() + first;
  float* squared = lists.squared.data() + first;
  std::size_t n = 0;
  for (std::size_t k = 0; k < around.count; ++k) {
    place[n] = around.place[k];
    squared[n] = work.squared[k];
    n += work.squared[k] < squared_radius && work.squared[k] > 0.0F ? 1U : 0U;
  }
  lists.place.resize(first + n);
  lists.squared.resize(first + n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t j = lists.place[first + k];
    work.arrays[0][k] = cloud.grid.x()[j];
    work.arrays[1][k] = cloud.grid.y()[j];
    work.arrays[2][k] = cloud.grid.z()[j];
    work.arrays[3][k] = cloud.nx[j];
    work.arrays[4][k] = cloud.ny[j];
    work.arrays[5][k] = cloud.nz[j];
    work.arrays[6][k] = lists.squared[first + k];
  }
  return n;
}

/// The Simplified Point Feature Histogram of one point into a padded row.
void fill_spfh(const Cloud& cloud, std::uint32_t i, std::size_t neighbours, Workspace& work, float* row) {
  const bool has_normal = cloud.nx[i] != 0.0F || cloud.ny[i] != 0.0F || cloud.nz[i] != 0.0F;
  if (neighbours == 0 || !has_normal) {
    return;
  }
  const auto& a = work.arrays;
  const internal::OrientedPoint point{{cloud.grid.x()[i], cloud.grid.y()[i], cloud.grid.z()[i]},
                                      {cloud.nx[i], cloud.ny[i], cloud.nz[i]}};
  const internal::NeighbourArrays to{a[0].data(), a[1].data(), a[2].data(), a[3].data(),
                                     a[4].data(), a[5].data(), a[6].data()};
  const std::size_t padded = (neighbours + internal::kLanes - 1) / internal::kLanes * internal::kLanes;
  internal::pair_bins(point, to, padded, work.bins[0].data(), work.bins[1].data(), work.bins[2].data());
  // Two copies: neighbours often fall into the same bin, and an increment must not wait for the one before.
  std::uint32_t counts[2][3][internal::kFpfhBins + 1] = {};
  for (std::size_t k = 0; k < neighbours; ++k) {
    auto& copy = counts[k & 1U];
    ++copy[0][work.bins[0][k]];
    ++copy[1][work.bins[1][k]];
    ++copy[2][work.bins[2][k]];
  }
  const auto valid = neighbours - counts[0][0][internal::kNoBin] - counts[1][0][internal::kNoBin];
  const float share = 100.0F / static_cast<float>(std::max<std::size_t>(1, valid));
  for (std::size_t h = 0; h < 3; ++h) {
    for (std::size_t b = 0; b < internal::kFpfhBins; ++b) {
      row[h * internal::kFpfhBins + b] = share * static_cast<float>(counts[0][h][b] + counts[1][h][b]);
    }
  }
}

/// Neighbour lists and SPFH rows of all points, task by task.
std::vector<NeighbourLists> simplified_histograms(const Cloud& cloud, float radius, std::vector<float>& rows) {
  const auto& cells = cloud.grid.cells();
  std::vector<NeighbourLists> tasks((cells.size() + kCellsPerTask - 1) / kCellsPerTask);
  parallel_blocks(cells.size(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    Workspace work;
    NeighbourLists& lists = tasks[begin / kCellsPerTask];
    for (std::size_t c = begin; c < end; ++c) {
      work.around.gather(cloud.grid, cells[c]);
      work.resize(work.around.count);
      for (std::uint32_t i = cells[c].run.begin; i < cells[c].run.end; ++i) {
        const std::size_t n = pick_neighbours(cloud, i, radius * radius, work, lists);
        fill_spfh(cloud, i, n, work, rows.data() + internal::kFpfhRow * i);
        lists.end.push_back(lists.place.size());
      }
    }
  });
  return tasks;
}

/// FPFH of one point: the neighbours' SPFH, weighted by the inverse of the squared distance as PCL does, each
/// of the three histograms scaled to a sum of 100.
void weigh_neighbours(const std::vector<float>& rows, const NeighbourLists& lists, std::size_t begin, std::size_t end,
                      std::vector<float>& weights, float* out) {
  weights.resize(end - begin);
  for (std::size_t k = begin; k < end; ++k) {
    weights[k - begin] = 1.0F / lists.squared[k];
  }
  std::array<float, internal::kFpfhRow> sum{};
  internal::weighted_sum(rows.data(), lists.place.data() + begin, weights.data(), end - begin, sum.data());
  for (std::size_t h = 0; h < 3; ++h) {
    const auto first = sum.begin() + static_cast<std::ptrdiff_t>(h * internal::kFpfhBins);
    const float total = std::accumulate(first, first + internal::kFpfhBins, 0.0F);
    const float scale = total > 0.0F ? 100.0F / total : 0.0F;
    std::transform(first, first + internal::kFpfhBins, out + h * internal::kFpfhBins,
                   [scale](float v) { return v * scale; });
  }
}

}  // namespace

search::DescriptorMatrix fpfh(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals,
                              const FpfhOptions& options, const std::vector<std::size_t>& wanted) {
  check(options);
  if (normals.size() != points.size()) {
    throw std::invalid_argument("fpfh: as many normals as points are needed");
  }
  const auto radius = static_cast<float>(options.radius_m);
  const search::CellGrid grid(points, radius * 1.0001F);
  const Cloud cloud(grid, normals);
  std::vector<float> rows(internal::kFpfhRow * grid.size(), 0.0F);
  const std::vector<NeighbourLists> tasks = simplified_histograms(cloud, radius, rows);

  constexpr std::size_t kUnwanted = static_cast<std::size_t>(-1);
  std::vector<std::size_t> row_of(points.size(), wanted.empty() ? 0 : kUnwanted);
  if (wanted.empty()) {
    std::iota(row_of.begin(), row_of.end(), std::size_t{0});
  }
  for (std::size_t r = 0; r < wanted.size(); ++r) {
    row_of.at(wanted[r]) = r;
  }
  search::DescriptorMatrix out = search::DescriptorMatrix::Zero(
      static_cast<Eigen::Index>(wanted.empty() ? points.size() : wanted.size()), kFpfhDimension);
  parallel_for(tasks.size(), [&](std::size_t t) {
    std::vector<float> weights;
    std::uint32_t i = grid.cells()[t * kCellsPerTask].run.begin;
    std::size_t begin = 0;
    for (const std::size_t end : tasks[t].end) {
      const std::size_t row = row_of[grid.index()[i]];
      if (row != kUnwanted && normals[grid.index()[i]].squaredNorm() > 0.5F) {
        weigh_neighbours(rows, tasks[t], begin, end, weights, out.row(static_cast<Eigen::Index>(row)).data());
      }
      begin = end;
      ++i;
    }
  });
  return out;
}

}  // namespace loopmark::features

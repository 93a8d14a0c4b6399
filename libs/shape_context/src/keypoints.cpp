// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "keypoints.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::shape_context::internal {
namespace {

/// The structure above one square of the ground plane.
struct Column {
  Eigen::Vector3d feet = Eigen::Vector3d::Zero();  ///< sum over the points
  double count = 0.0;
  float lowest = std::numeric_limits<float>::infinity();  ///< heights above the ground
  float highest = -std::numeric_limits<float>::infinity();

  void add(const Eigen::Vector3f& point, float height) {
    feet += Eigen::Vector3f(point.x(), point.y(), point.z() - height).cast<double>();
    count += 1.0;
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
};

std::vector<Column> structure_above_squares(const std::vector<Eigen::Vector3f>& points,
                                            const std::vector<float>& heights, const Options& options) {
  const auto inverse = static_cast<float>(1.0 / options.keypoint_m);
  search::VoxelTable squares(points.size() / 4);
  std::vector<Column> columns;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto height = static_cast<double>(heights[i]);
    const auto range = static_cast<double>(points[i].head<2>().norm());
    if (!(height >= options.min_height_m && height < options.max_height_m && range < options.max_range_m)) {
      continue;
    }
    search::Voxel square = search::voxel_of(points[i], inverse);
    square.z = 0;
    const std::uint32_t at = squares.insert(square);
    columns.resize(squares.size());
    columns[at].add(points[i], heights[i]);
  }
  return columns;
}

}  // namespace

std::vector<Eigen::Vector3f> choose_keypoints(const std::vector<Eigen::Vector3f>& points,
                                              const std::vector<float>& heights, const Options& options) {
  const std::vector<Column> columns = structure_above_squares(points, heights, options);
  std::vector<std::size_t> chosen(columns.size());
  std::iota(chosen.begin(), chosen.end(), 0);
  if (chosen.size() > options.max_keypoints) {
    const auto span = [&](std::size_t i) { return columns[i].highest - columns[i].lowest; };
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) { return span(a) > span(b); });
    chosen.resize(options.max_keypoints);
    std::sort(chosen.begin(), chosen.end());
  }
  std::vector<Eigen::Vector3f> keypoints;
  keypoints.reserve(chosen.size());
  for (const std::size_t i : chosen) {
    keypoints.emplace_back((columns[i].feet / columns[i].count).cast<float>());
  }
  return keypoints;
}

}  // namespace loopmark::shape_context::internal

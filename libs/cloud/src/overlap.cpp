// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/overlap.hpp"

#include <algorithm>
#include <numbers>

#include "loopmark/cloud/voxel.hpp"

namespace loopmark::cloud {
namespace {

constexpr double kVoxel = 1.0;
constexpr auto kNear = std::numbers::sqrt2_v<float>;

Overlap ratios(std::size_t near, std::size_t source, std::size_t target) {
  const auto n = static_cast<double>(near);
  const double of_source = source == 0 ? 0.0 : n / static_cast<double>(source);
  const double of_target = target == 0 ? 0.0 : n / static_cast<double>(target);
  return {of_source, std::min(of_source, of_target)};
}

template <class Range, class Move>
std::size_t count_near(const Range& source, const search::KdTree& target, const Move& move) {
  return static_cast<std::size_t>(std::count_if(source.begin(), source.end(), [&](const Eigen::Vector3f& point) {
    return target.nearest(move(point), kNear).has_value();
  }));
}

}  // namespace

OverlapCloud::OverlapCloud(const std::vector<Eigen::Vector3f>& points) : tree_(voxel_centroids(points, kVoxel)) {}

Overlap overlap(const OverlapCloud& source, const OverlapCloud& target, const Pose& T_target_source) {
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  const auto& points = source.tree().points();
  const std::size_t near =
      count_near(points, target.tree(), [&](const Eigen::Vector3f& p) -> Eigen::Vector3f { return T * p; });
  return ratios(near, points.size(), target.tree().points().size());
}

Overlap overlap(const PointCloud& source, const PointCloud& target, const Pose& T_target_source) {
  const auto moved = voxel_centroids(transformed(source, T_target_source).points, kVoxel);
  const search::KdTree tree(voxel_centroids(target.points, kVoxel));
  const std::size_t near = count_near(moved, tree, [](const Eigen::Vector3f& p) { return p; });
  return ratios(near, moved.size(), tree.points().size());
}

}  // namespace loopmark::cloud

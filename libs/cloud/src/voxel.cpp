// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/cloud/voxel.hpp"

#include "loopmark/core/error.hpp"
#include "loopmark/search/voxel_table.hpp"

namespace loopmark::cloud {
namespace {

float inverse_of(double size_m) {
  if (!(size_m > 0.0)) {
    throw InputError("the voxel size must be above 0 m");
  }
  return static_cast<float>(1.0 / size_m);
}

}  // namespace

std::vector<std::size_t> voxel_first_indices(const std::vector<Eigen::Vector3f>& points, double size_m) {
  const float inverse = inverse_of(size_m);
  search::VoxelTable table(points.size() / 4);
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (table.insert(search::voxel_of(points[i], inverse)) == first.size()) {
      first.push_back(i);
    }
  }
  return first;
}

std::vector<std::size_t> voxel_central_indices(const std::vector<Eigen::Vector3f>& points, double size_m) {
  const float inverse = inverse_of(size_m);
  search::VoxelTable table(points.size() / 4);
  std::vector<std::size_t> central;
  std::vector<float> least;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const search::Voxel voxel = search::voxel_of(points[i], inverse);
    const Eigen::Vector3f centre =
        Eigen::Vector3f(static_cast<float>(voxel.x), static_cast<float>(voxel.y), static_cast<float>(voxel.z)) +
        Eigen::Vector3f::Constant(0.5F);
    const float squared = (points[i] * inverse - centre).squaredNorm();
    const std::uint32_t place = table.insert(voxel);
    if (place == central.size()) {
      central.push_back(i);
      least.push_back(squared);
    } else if (squared < least[place]) {
      central[place] = i;
      least[place] = squared;
    }
  }
  return central;
}

std::vector<Eigen::Vector3f> voxel_centroids(const std::vector<Eigen::Vector3f>& points, double size_m) {
  const float inverse = inverse_of(size_m);
  search::VoxelTable table(points.size() / 4);
  std::vector<Eigen::Vector3d> sums;
  std::vector<double> counts;
  for (const Eigen::Vector3f& point : points) {
    const std::uint32_t voxel = table.insert(search::voxel_of(point, inverse));
    if (voxel == sums.size()) {
      sums.emplace_back(0.0, 0.0, 0.0);
      counts.push_back(0.0);
    }
    sums[voxel] += point.cast<double>();
    counts[voxel] += 1.0;
  }
  std::vector<Eigen::Vector3f> centroids;
  centroids.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    centroids.emplace_back((sums[i] / counts[i]).cast<float>());
  }
  return centroids;
}

PointCloud voxel_downsampled(const PointCloud& cloud, double size_m) {
  return select(cloud, voxel_first_indices(cloud.points, size_m));
}

}  // namespace loopmark::cloud

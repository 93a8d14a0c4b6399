// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Voxel downsampling. The results depend on the order of the points only.
#pragma once

#include <cstddef>
#include <vector>

#include "loopmark/core/point_cloud.hpp"

namespace loopmark::cloud {

/// Indices of one original point a voxel, the first seen, in ascending order: the paper's downsampling
/// (voxel 0.3 m, original points rather than centroids). size_m: edge of a voxel, metres, > 0.
std::vector<std::size_t> voxel_first_indices(const std::vector<Eigen::Vector3f>& points, double size_m);

/// Indices of one original point a voxel, the one nearest to its centre, in the order in which the voxels are first
/// seen. The first point of a voxel in the order of a sweep lies to the side that the sweep comes from; this one to
/// none. size_m: edge of a voxel, metres, > 0.
std::vector<std::size_t> voxel_central_indices(const std::vector<Eigen::Vector3f>& points, double size_m);

/// The centroids of the occupied voxels, in the order in which the voxels are first seen.
std::vector<Eigen::Vector3f> voxel_centroids(const std::vector<Eigen::Vector3f>& points, double size_m);

/// One original point a voxel, with every channel of the cloud.
PointCloud voxel_downsampled(const PointCloud& cloud, double size_m);

}  // namespace loopmark::cloud

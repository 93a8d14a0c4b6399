// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The same work by PCL and FLANN; false where they are not installed.
#pragma once

#include <vector>

#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::benchmarks {

/// pcl::FPFHEstimationOMP on the same cloud, normals and radius.
bool peer_fpfh(const std::vector<Eigen::Vector3f>& points, const std::vector<Eigen::Vector3f>& normals, double radius_m,
               int threads);

/// Exact two nearest in both directions by FLANN's single k-d tree, building included.
bool peer_nearest_two(const search::DescriptorMatrix& source, const search::DescriptorMatrix& target, int threads);

}  // namespace loopmark::benchmarks

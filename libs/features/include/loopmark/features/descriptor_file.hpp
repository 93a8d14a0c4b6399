// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::features {

/// Points with descriptors computed elsewhere, for example by a trained network.
struct DescriptorFile {
  std::vector<Eigen::Vector3f> points;  ///< metres, in the sensor's frame, one a row of the descriptors
  search::DescriptorRows descriptors;   ///< whole numbers where the file holds int8
};

/// Reads a .npz archive of NumPy, stored or compressed, as FCGF, D3Feat and others export it: descriptors in an array
/// "feature", "features", "descriptors" or "descs" of shape (n, d), points in "xyz", "xyz_down", "keypts", "keypoints"
/// or "points" of shape (n, 3). Throws InputError naming file, array, problem and remedy.
DescriptorFile read_descriptors(const std::filesystem::path& npz);

/// Reads the two arrays from two .npy files.
DescriptorFile read_descriptors(const std::filesystem::path& descriptors_npy, const std::filesystem::path& points_npy);

}  // namespace loopmark::features

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "loopmark/search/descriptor_matrix.hpp"

namespace loopmark::features {

/// Writes a .npz archive that numpy.load and read_descriptors open: "xyz" of float32 (n, 3) and "features" (n, d), of
/// float32 or, quantised, of int8. The file is written whole or not at all, and its bytes depend on the numbers only.
/// Throws std::invalid_argument when there are more or fewer points than rows, InputError when it cannot be written.
void export_descriptors(const std::filesystem::path& npz, const std::vector<Eigen::Vector3f>& points,
                        const search::DescriptorRows& descriptors);

}  // namespace loopmark::features

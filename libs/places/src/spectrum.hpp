// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "loopmark/places/place_descriptor.hpp"

namespace loopmark::places::internal {

/// Square root of the height of what stands in each cell, fading out towards the radius; x along rows.
Eigen::MatrixXf bev_image(const std::vector<Eigen::Vector3f>& levelled_points, const PlaceOptions& options);

/// Magnitudes of the image's low frequencies on a polar grid: radii x angles.
Eigen::MatrixXf polar_spectrum(const Eigen::MatrixXf& image, const PlaceOptions& options);

/// Magnitudes of the first harmonics of each row: radii x harmonics.
Eigen::MatrixXf direction_harmonics(const Eigen::MatrixXf& polar, const PlaceOptions& options);

}  // namespace loopmark::places::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "loopmark/shape_context/options.hpp"

namespace loopmark::shape_context::internal {

/// The feet of columns that hold structure: the mean of a column's points in x and y, on the ground below them. Two
/// scans see a trunk at different heights, but its foot is one place. Of more than max_keypoints the columns whose
/// structure spans the most height are kept; among equal ones those seen first. `points`: levelled frame; `heights`
/// above the ground; metres. In first-seen order.
std::vector<Eigen::Vector3f> choose_keypoints(const std::vector<Eigen::Vector3f>& points,
                                              const std::vector<float>& heights, const Options& options);

}  // namespace loopmark::shape_context::internal

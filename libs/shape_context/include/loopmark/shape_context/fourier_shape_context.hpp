// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A local descriptor that needs no learning: what stands around a keypoint, seen from above in bands of height over
/// the ground, as a polar histogram (a shape context) that its Fourier transform makes independent of yaw.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "loopmark/search/descriptor_matrix.hpp"
#include "loopmark/shape_context/options.hpp"

namespace loopmark::shape_context {

constexpr int kDimension = 992;

struct Keypoints {
  std::vector<Eigen::Vector3f> points;       ///< metres, in the frame of the scan, on the ground
  search::QuantizedDescriptors descriptors;  ///< one row a point
};

/// Describes structure in a frame whose z points up. `heights`: of each point above the ground below it, metres; the
/// points should be thinned (0.3 to 0.4 m). The same bytes at any number of threads.
/// Throws std::invalid_argument when there are more or fewer heights than points.
Keypoints describe_structure(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& heights,
                             const Options& options);

/// Finds the ground of a scan (points in the sensor's frame, z roughly up) and describes what stands on it; the
/// keypoints are in the sensor's frame.
Keypoints describe_scan(const std::vector<Eigen::Vector3f>& points, const Options& options);

}  // namespace loopmark::shape_context

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Estimators of other libraries, where they are installed, on the same matches as ours.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::benchmarks {

/// An estimator under its name: matched points, the best first, to a motion.
struct NamedEstimator {
  std::string name;
  std::function<Pose(const PointPairs&)> estimate;
};

/// RANSAC (3 points, edge-length and distance check, 100 k iterations, confidence 0.999) and Fast Global
/// Registration of Open3D. Empty where Open3D is not installed.
std::vector<NamedEstimator> open3d_estimators();

/// SampleConsensusPrerejective of PCL (50 k iterations, similarity 0.9). Empty where PCL is not installed.
std::vector<NamedEstimator> pcl_estimators();

}  // namespace loopmark::benchmarks

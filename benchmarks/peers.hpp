// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What other libraries do, where they are installed: estimators on the same matches as ours, and whole pipelines.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/estimation/point_pairs.hpp"

namespace loopmark::benchmarks {

/// An estimator under its name: matched points, the best first, to a motion.
struct NamedEstimator {
  std::string name;
  std::function<Pose(const estimation::PointPairs&)> estimate;
};

/// RANSAC (3 points, edge-length and distance check, 100 k iterations, confidence 0.999) and Fast Global
/// Registration of Open3D. Empty where Open3D is not installed.
std::vector<NamedEstimator> open3d_estimators();

/// SampleConsensusPrerejective of PCL (50 k iterations, similarity 0.9). Empty where PCL is not installed.
std::vector<NamedEstimator> pcl_estimators();

/// A library with registration of its own. What it makes of a scan (points in the sensor's frame, metres) is its
/// secret: 0.3 m voxels, normals of 1.2 m and FPFH of 2.4 m, by its own means.
struct PeerLibrary {
  using Scan = std::shared_ptr<const void>;
  struct Finder {
    std::string name;
    std::function<std::optional<Pose>(const void* source, const void* target)> find;  ///< nothing: it found no motion
  };
  struct Refiner {
    std::string name;
    std::function<Pose(const void* source, const void* target, const Pose& start)> refine;
  };

  std::string name;
  std::function<Scan(const std::vector<Eigen::Vector3f>&)> prepare;
  std::vector<Finder> finders;
  std::vector<Refiner> refiners;  ///< of what the finders found
};

/// RANSAC on mutual FPFH matches and Fast Global Registration. Nothing where Open3D is not installed.
std::optional<PeerLibrary> open3d_library();

/// SampleConsensusPrerejective on FPFH; GICP and NDT as refinement. Nothing where PCL is not installed.
std::optional<PeerLibrary> pcl_library();

}  // namespace loopmark::benchmarks

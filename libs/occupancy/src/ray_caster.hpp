// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Which voxels one scan passes and which it hits.
#pragma once

#include <cstddef>
#include <vector>

#include "bit_volume.hpp"
#include "loopmark/occupancy/occupancy_options.hpp"

namespace loopmark::occupancy::internal {

/// The voxels of one scan. `passed` may hold hit voxels too: being hit wins.
struct ScanVoxels {
  Box box;
  Words passed;
  Words hit;
  std::size_t rays = 0;
  std::size_t skipped_points = 0;
};

/// Walks every ray as octomap::OcTreeBaseImpl::computeRayKeys does (Amanatides and Woo 1987), with the same
/// arithmetic, so that the sets are equal to those of octomap's computeUpdate. Points and origin in the map's frame.
/// Sets are unions: the same at any number of threads.
class RayCaster {
 public:
  explicit RayCaster(const OccupancyOptions& options);

  /// The result is valid until the next call.
  const ScanVoxels& cast(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& origin);

 private:
  /// A ray to walk: its end, cut at the maximum range.
  struct Ray {
    Eigen::Vector3f end;
    Key end_key;
    bool hits = true;
  };

  void make_rays(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& origin, const Key& origin_key);
  void walk(const Ray& ray, const Eigen::Vector3f& origin, const Key& origin_key, std::uint64_t* passed) const;

  double resolution_;
  double inverse_resolution_;
  double max_range_;
  std::vector<Ray> rays_;
  std::vector<Words> parts_;  ///< passed voxels, one volume for each block of rays
  ScanVoxels voxels_;
};

}  // namespace loopmark::occupancy::internal

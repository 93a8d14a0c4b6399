// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_centers.hpp"

#include <unordered_map>

#include "loopmark/search/voxel.hpp"

namespace loopmark::localization::internal {

std::vector<std::size_t> place_centers(const std::vector<Pose>& T_map_keyframe, double near_m) {
  std::unordered_map<search::Voxel, std::vector<std::size_t>, search::VoxelHash> centers;
  const auto cell_of = [&](const Eigen::Vector3d& p) {
    return search::voxel_of(p.cast<float>(), static_cast<float>(1.0 / near_m));
  };
  std::vector<std::size_t> center_of;
  for (std::size_t k = 0; k < T_map_keyframe.size(); ++k) {
    const Eigen::Vector3d position = T_map_keyframe[k].translation();
    std::size_t nearest = k;
    double least = near_m;
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3d step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const auto found = centers.find(cell_of(position + near_m * step));
      if (found == centers.end()) {
        continue;
      }
      for (const std::size_t center : found->second) {
        const double away = (T_map_keyframe[center].translation() - position).norm();
        if (away < least) {
          least = away;
          nearest = center;
        }
      }
    }
    center_of.push_back(nearest);
    if (nearest == k) {
      centers[cell_of(position)].push_back(k);
    }
  }
  return center_of;
}

}  // namespace loopmark::localization::internal

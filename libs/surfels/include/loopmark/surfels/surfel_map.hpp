// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A scan as small planar surfels: one for each occupied voxel.
#pragma once

#include <vector>

#include "loopmark/search/voxel_table.hpp"

namespace loopmark::surfels {

/// The points of one voxel, summed up. Levelled frame, metres.
struct Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float planarity = 0.0F;  ///< 0: a line or a blob, 1: a plane
  float height = 0.0F;     ///< of the mean above the ground below it, metres
};

/// Surfels by voxel; nearest-surfel queries look at the voxel and its 26 neighbours. Voxels are kept in bricks of 4 x 4
/// x 4 with one bit each, so that empty neighbours cost a bit test and not a search.
class SurfelMap {
 public:
  SurfelMap() : bricks_(0) {}
  /// `surfels`: at most one a voxel of edge size_m; others of the same voxel are dropped.
  SurfelMap(std::vector<Surfel> surfels, float size_m);

  float size_m() const { return size_m_; }
  /// In the order of the bricks.
  const std::vector<Surfel>& surfels() const { return surfels_; }

  /// The surfel whose mean is nearest to `point` and nearer than `max_distance` (at most size_m for an exact
  /// answer); null when there is none.
  const Surfel* nearest(const Eigen::Vector3f& point, float max_distance) const;

 private:
  struct Brick {
    std::uint64_t occupied = 0;  ///< bit x + 4 y + 16 z of the voxel within the brick
    std::uint32_t first = 0;     ///< of its surfels, which stand in the order of the bits
  };

  search::VoxelTable bricks_;
  std::vector<Brick> contents_;
  std::vector<Surfel> surfels_;
  float size_m_ = 1.0F;
};

/// One surfel for each voxel of edge size_m: the mean of its points; the normal and the planarity of all points in it
/// and its 26 neighbours. `points`: levelled frame, dense.
std::vector<Surfel> make_surfels(const std::vector<Eigen::Vector3f>& points, float size_m);

/// Joins the surfels of fine voxels into those of voxels `factor` times as wide.
std::vector<Surfel> coarsened(const SurfelMap& fine, int factor);

}  // namespace loopmark::surfels

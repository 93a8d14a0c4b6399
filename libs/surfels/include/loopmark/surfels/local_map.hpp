// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/search/voxel_table.hpp"

namespace loopmark::surfels {

/// The map point that is nearest to a query.
struct MapMatch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, either side; zero where the surface is no plane
  double distance_m = 0.0;
};

/// The surroundings that scans are aligned to: a hash of voxels with a few well spread points each and the
/// normals of the surface around them. Points in metres in the map's frame.
class LocalMap {
 public:
  static constexpr std::size_t kMaxPoints = 20;  ///< in one voxel

  LocalMap(double voxel_m, std::size_t points_per_voxel);

  /// Adds points (map frame) that are not too close to one that is there, then renews the normals around them.
  void insert(const std::vector<Eigen::Vector3d>& points);

  /// The nearest point within `max_distance` (at most half a voxel is sure to be seen whole; farther
  /// neighbours are looked for in the adjacent voxels only). False: none.
  bool nearest(const Eigen::Vector3d& query, double max_distance, MapMatch& match) const;

  /// Drops the voxels whose corner is farther than `radius` from `center`.
  void forget_beyond(const Eigen::Vector3d& center, double radius);

  /// The whole map as bytes, for the same program on the same machine; from_bytes throws InputError on others.
  std::string to_bytes() const;
  static LocalMap from_bytes(const std::string& bytes);

  double voxel_m() const { return voxel_m_; }
  bool empty() const { return cells_.empty(); }
  std::size_t voxel_count() const { return cells_.size(); }

 private:
  struct Cell {
    std::uint32_t count = 0;
    std::array<Eigen::Vector3f, kMaxPoints> offset;  ///< from the voxel's corner
    std::array<Eigen::Vector3f, kMaxPoints> normal;
  };

  search::Voxel voxel_at(const Eigen::Vector3d& point) const;
  Eigen::Vector3d corner(const search::Voxel& voxel) const;
  bool add(Cell& cell, const Eigen::Vector3f& offset) const;
  void renew_normals(std::uint32_t cell);

  double voxel_m_;
  std::size_t capacity_;
  float spacing_squared_;
  search::VoxelTable table_;
  std::vector<Cell> cells_;
};

}  // namespace loopmark::surfels

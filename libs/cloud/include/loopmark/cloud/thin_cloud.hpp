// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Clouds that grow and stay thin: one point a voxel, the first seen.
#pragma once

#include <array>
#include <filesystem>
#include <functional>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/search/voxel_table.hpp"
#include "loopmark/storage/spill_store.hpp"

namespace loopmark::cloud {

/// One point a voxel, in memory.
class ThinCloud {
 public:
  explicit ThinCloud(double voxel_m = 1.0);

  /// Whether the point was the first of its voxel and is kept now.
  bool add(const Eigen::Vector3f& point, float intensity = 0.0F);

  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  const std::vector<float>& intensity() const { return intensity_; }

  // As an item of a SpillStore.
  std::size_t weight() const { return points_.size(); }
  std::string to_bytes() const;
  static ThinCloud from_bytes(const std::string& bytes);

 private:
  float inverse_;
  search::VoxelTable table_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> intensity_;
};

/// The same without end: cubes of 128 voxels that were not used lately wait on the disk.
class TiledCloud {
 public:
  /// `scratch`: a file that is made and removed again.
  TiledCloud(double voxel_m, const std::filesystem::path& scratch, std::size_t max_points_in_memory = 1'000'000);

  /// Adds points and, while every cloud has had it, their intensity. Throws InputError when the disk is full.
  void add(const PointCloud& cloud);

  std::size_t size() const { return size_; }
  /// The points cube by cube, in an order that does not depend on memory.
  void for_each_tile(const std::function<void(const PointCloud&)>& visit);

 private:
  using Key = std::array<std::int32_t, 3>;

  double voxel_m_;
  storage::SpillStore<Key, ThinCloud> tiles_;
  bool with_intensity_ = true;
  std::size_t size_ = 0;
};

/// The same in one segment for an overview: voxels grow by two whenever there are more than `most` points.
class OverviewCloud {
 public:
  OverviewCloud(double voxel_m, std::size_t most);
  void add(const std::vector<Eigen::Vector3f>& points);
  const std::vector<Eigen::Vector3f>& points() const { return cloud_.points(); }
  double voxel_m() const { return voxel_m_; }  ///< now

 private:
  double voxel_m_;
  std::size_t most_;
  ThinCloud cloud_;
};

}  // namespace loopmark::cloud

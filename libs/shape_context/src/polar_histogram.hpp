// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Polar histograms of what stands around a point, seen from above (shape contexts; Belongie, Malik and Puzicha 2002),
/// one for each band of height above the ground.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "polar_histogram_kernels.hpp"

namespace loopmark::shape_context::internal {

constexpr std::size_t kBands = 2;
constexpr std::array<float, kBands> kBandFrom = {0.3F, 2.0F};  ///< metres above the ground; the last has no end

/// bins[band][ring][sector]: occupied voxels, spread bilinearly over rings and sectors.
using PolarHistogram = std::array<std::array<std::array<float, kSectors>, kRings>, kBands>;

/// The structure of a scan in columns of 0.3 m, ordered for look-ups by place.
class StructureColumns {
 public:
  static constexpr float kColumn = 0.3F;  ///< metres, edge of a column and of the voxels that are counted in it
  static constexpr float kCell = 2.0F;    ///< metres, edge of the cells of the look-up

  /// `points`: levelled frame, metres; `heights` above the ground below them. What lies lower than the lowest band is
  /// left out.
  StructureColumns(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& heights);

  std::size_t size() const { return x_.size(); }

  /// The histogram of all columns nearer than `radius` to (x, y).
  PolarHistogram around(float x, float y, float radius) const;

 private:
  struct Workspace;
  void gather(float x, float y, float radius, Workspace& work) const;

  float x0_ = 0.0F;  ///< corner of the look-up, metres
  float y0_ = 0.0F;
  int width_ = 0;  ///< cells
  int height_ = 0;
  std::vector<std::uint32_t> first_;  ///< of each cell, row by row, and one past the last
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> weight_;
  std::vector<std::uint8_t> band_;
};

}  // namespace loopmark::shape_context::internal

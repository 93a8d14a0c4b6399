// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark {

/// Points in metres in the sensor's frame (x forward, y left, z up unless the log says otherwise).
/// The other channels are either empty or as long as `points`.
struct PointCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> intensity;      ///< reflectance, in the unit of the log
  std::vector<float> time_offset_s;  ///< time of each point relative to the stamp of its scan, seconds
  std::vector<std::uint16_t> ring;   ///< laser number, 0 the lowest

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
};

/// One sweep of a log.
struct Scan {
  std::size_t index = 0;  ///< place in the log, from 0
  double stamp_s = 0.0;   ///< reference time of the scan, seconds
  PointCloud cloud;
};

/// Moves every point: p' = T_target_source * p. Other channels are kept.
PointCloud transformed(const PointCloud& cloud, const Pose& T_target_source);

/// The points of `cloud` at `indices`, in that order, with every channel that is there.
PointCloud select(const PointCloud& cloud, const std::vector<std::size_t>& indices);

/// Adds all points of `more`; a channel stays only where both have it.
void append(PointCloud& cloud, const PointCloud& more);

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The height of the ground around a levelled scan, following slopes, and what stands on it.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace loopmark::bev {

/// Height of the ground over a square grid centred on the sensor, levelled frame, metres.
class GroundMap {
 public:
  static constexpr int kSide = 100;       ///< cells a side
  static constexpr float kCell = 2.0F;    ///< metres
  static constexpr float kSlope = 0.15F;  ///< steepest ground that is followed

  /// Grows the ground outwards from the sensor: a cell's lowest points are ground when they lie within the
  /// slope of the ground nearer to the sensor; else the cell inherits. `points`: levelled frame.
  explicit GroundMap(const std::vector<Eigen::Vector3f>& points);
  GroundMap() : ground_(kSide * kSide, 0.0F), seen_(kSide * kSide, 0) {}  ///< level, and nothing of it seen

  /// Height of the ground below a point (bilinear), metres in the levelled frame.
  float ground(float x, float y) const;
  /// Whether ground was seen in the cell of this point; else its height is carried on from nearer cells.
  bool seen(float x, float y) const;
  /// Height of a point above the ground below it, metres.
  float height_above(const Eigen::Vector3f& p) const { return p.z() - ground(p.x(), p.y()); }

 private:
  std::vector<float> ground_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace loopmark::bev

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the beams of one scan passed through.
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::registration {

/// The nearest and the farthest return in each direction, in bins of one degree of azimuth and elevation.
class RangeImage {
 public:
  static constexpr int kColumns = 360;
  static constexpr int kRows = 100;      ///< elevation -50 to 50 degrees
  static constexpr float kUnit = 0.01F;  ///< metres of one step of the stored ranges

  struct Cell {
    std::uint16_t nearest = 0;  ///< 0: no return, not known
    std::uint16_t farthest = 0;
  };

  RangeImage() : cells_(kColumns * kRows) {}
  /// `points` in the sensor's own frame, metres.
  explicit RangeImage(const std::vector<Eigen::Vector3f>& points);
  explicit RangeImage(std::vector<Cell> cells) : cells_(std::move(cells)) {}

  enum class Sight {
    kUnknown,             ///< no beam went there
    kHidden,              ///< behind what the beams met
    kAgrees,              ///< where the beams met something
    kFreeSpaceViolation,  ///< where the beams passed through
    kStrongViolation,     ///< the same, and so did all beams of the directions around it: no edge, no hole in a crown
  };

  /// How a point (sensor's frame) goes with what this scan saw. `margin_m` is the tolerance in range.
  Sight look_at(const Eigen::Vector3f& point, float margin_m) const;

  const std::vector<Cell>& cells() const { return cells_; }

 private:
  /// Whether every beam in and around this bin went farther than `range` metres.
  bool passes_around(int bin, float range) const;

  std::vector<Cell> cells_;
};

}  // namespace loopmark::registration

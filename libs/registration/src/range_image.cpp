// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopmark::registration {
namespace {

constexpr float kDegrees = 180.0F / std::numbers::pi_v<float>;

/// The bin of a direction, or -1 outside the image.
int bin_of(const Eigen::Vector3f& p) {
  const float elevation = std::atan2(p.z(), std::hypot(p.x(), p.y())) * kDegrees;
  const int row = static_cast<int>(std::floor(elevation)) + RangeImage::kRows / 2;
  if (row < 0 || row >= RangeImage::kRows) {
    return -1;
  }
  const float azimuth = std::atan2(p.y(), p.x()) * kDegrees + 180.0F;
  const int column = std::min(static_cast<int>(azimuth), RangeImage::kColumns - 1);
  return row * RangeImage::kColumns + column;
}

}  // namespace

RangeImage::RangeImage(const std::vector<Eigen::Vector3f>& points) : cells_(kColumns * kRows) {
  for (const Eigen::Vector3f& p : points) {
    const int bin = bin_of(p);
    if (bin < 0) {
      continue;
    }
    const auto range = static_cast<std::uint16_t>(std::clamp(p.norm() / kUnit, 1.0F, 65535.0F));
    Cell& cell = cells_[static_cast<std::size_t>(bin)];
    cell.nearest = cell.nearest == 0 ? range : std::min(cell.nearest, range);
    cell.farthest = std::max(cell.farthest, range);
  }
}

bool RangeImage::passes_around(int bin, float range) const {
  const int row = bin / kColumns;
  const int column = bin % kColumns;
  for (int y = std::max(0, row - 1); y <= std::min(kRows - 1, row + 1); ++y) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = (column + dx + kColumns) % kColumns;
      const Cell& cell = cells_[static_cast<std::size_t>(y * kColumns + x)];
      if (cell.nearest != 0 && static_cast<float>(cell.nearest) * kUnit < range) {
        return false;
      }
    }
  }
  return true;
}

RangeImage::Sight RangeImage::look_at(const Eigen::Vector3f& point, float margin_m) const {
  const int bin = bin_of(point);
  if (bin < 0 || cells_[static_cast<std::size_t>(bin)].nearest == 0) {
    return Sight::kUnknown;
  }
  const Cell& cell = cells_[static_cast<std::size_t>(bin)];
  const float range = point.norm();
  if (range < static_cast<float>(cell.nearest) * kUnit - margin_m) {
    return passes_around(bin, range + margin_m) ? Sight::kStrongViolation : Sight::kFreeSpaceViolation;
  }
  return range > static_cast<float>(cell.farthest) * kUnit + margin_m ? Sight::kHidden : Sight::kAgrees;
}

}  // namespace loopmark::registration

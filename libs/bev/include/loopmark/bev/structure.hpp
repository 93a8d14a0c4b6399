// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Where structure stands, seen from above.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "loopmark/bev/ground_map.hpp"

namespace loopmark::bev {

constexpr float kStructureCell = 0.5F;                                           ///< edge of a structure cell, metres
constexpr std::size_t kBands = 3;                                                ///< height bands above the ground: ...
constexpr std::array<float, kBands + 1> kBandEdges = {0.4F, 1.5F, 3.0F, 15.0F};  ///< ... their edges, metres

/// A cell of the ground plane with structure above it; levelled frame, metres.
struct StructureCell {
  float x = 0.0F;
  float y = 0.0F;
  std::uint8_t bands = 0;  ///< bit b: points in height band b
};

/// A cell of the ground itself and how far it stands out from the ground around it; levelled frame, metres.
struct ReliefCell {
  float x = 0.0F;
  float y = 0.0F;
  float relief = 0.0F;  ///< metres, from -kMostRelief to kMostRelief
};

/// What is seen of a scan from above.
struct BirdseyeView {
  std::vector<StructureCell> structure;
  std::vector<ReliefCell> relief;
};

constexpr float kReliefRadius = 5.0F;  ///< metres around a cell whose mean height it is compared with
constexpr float kMostRelief = 0.25F;   ///< metres: more than this is no relief of the ground

/// One cell for each 0.5 m square that holds points in a height band, in first-seen order. Bands rather than the
/// highest point: a roof or a crown then hides nothing of what stands below it. `points`: levelled frame, metres.
std::vector<StructureCell> structure_cells(const std::vector<Eigen::Vector3f>& points, const GroundMap& ground);

/// One cell for each 0.5 m square of ground (up to kStructureCell above or below the ground map): the mean height of
/// its points less that of all ground within kReliefRadius. Kerbs, verges and the lie of the land tell places apart
/// where hardly anything stands. In first-seen order. `points`: levelled frame, metres.
std::vector<ReliefCell> relief_cells(const std::vector<Eigen::Vector3f>& points, const GroundMap& ground);

}  // namespace loopmark::bev

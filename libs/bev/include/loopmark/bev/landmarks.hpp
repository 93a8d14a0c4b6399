// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Things that stand alone (trunks, poles, signs, bushes), and motions between two scans that bring several of one onto
/// those of the other. Where hardly anything stands, a turn by one step of the correlation moves what is far by more
/// than its cells: there these few are compared directly.
#pragma once

#include <vector>

#include "loopmark/bev/correlation.hpp"

namespace loopmark::bev {

/// A small group of structure cells with nothing near it. Levelled frame, metres.
struct Landmark {
  float x = 0.0F;
  float y = 0.0F;
  bool tall = false;  ///< reaches above the lowest height band: not a car, not a person
};

constexpr float kLandmarkWidth = 5.0F;      ///< widest landmark, metres
constexpr std::size_t kMostLandmarks = 48;  ///< of a scan: the tall ones first, then the near ones

/// Groups of cells that touch, no wider than kLandmarkWidth.
std::vector<Landmark> find_landmarks(const std::vector<StructureCell>& cells);

/// Planar motions by which landmarks of the source fall onto landmarks of the target (at least 3, within 1 m), at most
/// `most`, best first. Every pair of landmarks votes with every pair of the other scan that is as far apart (within
/// 0.8 m). score: landmarks met (a low one counts half), less a quarter of those not met within 40 m of both sensors.
std::vector<PlanarHypothesis> match_landmarks(const std::vector<Landmark>& source, const std::vector<Landmark>& target,
                                              std::size_t most);

/// The score of one planar motion (radians, metres).
double landmark_score(const std::vector<Landmark>& source, const std::vector<Landmark>& target, double yaw, double x,
                      double y);

}  // namespace loopmark::bev

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/odometry/odometry.hpp"

namespace loopmark::odometry {

constexpr std::size_t kLeastStructure = 4;  // keypoints above the ground that can tell one answer from another
constexpr double kUsualGapS = 0.2;          // longer gaps between scans make the prediction less certain
constexpr double kFastest = 35.0;           // m/s

/// Whether the rates of motion over two gaps between scans can be held against each other: they are short and alike, so
/// that nothing happened in between and no stamp is wrong.
bool even(double gap_s, double last_gap_s);

/// Straight motions over each distance: ahead, to the left, back and to the right.
std::vector<Pose> straight_motions(const std::vector<double>& distances_m);

/// A guess of where the scan is; how its motion follows from the last scan unless the guess says otherwise.
struct Odometry::Start {
  Pose T_map_lidar;
  Vector6d velocity;
};

}  // namespace loopmark::odometry

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The numbers that tell a right motion from a wrong one, each independent of how the motion was found.
#pragma once

#include <array>
#include <string_view>

#include "alignment.hpp"

namespace loopmark {

/// What one height class of the structure of one scan, moved into the other, says.
struct Voices {
  double met = 0.0;       ///< patches with a patch of the other scan within 0.4 m
  double conflict = 0.0;  ///< where the other scan's beams passed through
  double unmet = 0.0;     ///< at a range at which the other's beams met something, but no patch near
};

/// Counts of one direction.
struct Testimony {
  double structure = 0.0;  ///< patches that stand above the ground
  Voices low;              ///< up to 2.2 m above the ground: cars and people may have come and gone
  Voices tall;             ///< higher: buildings, trunks and poles, which stay
  double tight = 0.0;      ///< met within 0.15 m along the other's normal
  double alike = 0.0;      ///< sum of (n . n')^2 over planar met patches
  double planar = 0.0;     ///< planar met patches
  double cells = 0.0;      ///< cells of a 10 m grid with at least 5 met patches

  double met() const { return low.met + tall.met; }
};

constexpr std::size_t kFeatures = 13;
using Features = std::array<double, kFeatures>;
/// agreement: share of the structure that is met, up to a quarter; surplus: what is above it. Their sum is the share
/// itself: a quarter is what low overlap gives, and more than that is worth nothing while beams pass through the rest
/// (blocks that look alike).
constexpr std::array<std::string_view, kFeatures> kFeatureNames = {
    "agreement", "low_presence", "low_conflict", "tall_presence", "tall_conflict", "normals", "tightness",
    "residual",  "peak",         "support",      "spread",        "constraint",    "surplus"};

/// Moves the structure of `source` by T (levelled frames) and asks the target's patches and beams.
Testimony ask(const PreparedScan::Data& source, const PreparedScan::Data& target, const Pose& T_target_source);

/// The features of one hypothesis: what both directions say, the alignment's residual and conditioning, and the height
/// of its correlation peak (0 where it has none).
Features features_of(const PreparedScan::Data& source, const PreparedScan::Data& target, const Alignment& alignment,
                     double peak);

}  // namespace loopmark

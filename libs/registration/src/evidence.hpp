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
  double clash = 0.0;     ///< of these, where all beams around did as well
  double unmet = 0.0;     ///< at a range at which the other's beams met something, but no patch near
};

/// Counts of one direction; where fewer patches than kAllAsked are asked, each counts for those it stands for.
struct Testimony {
  double structure = 0.0;    ///< patches that stand above the ground
  Voices low;                ///< up to 2.2 m above the ground: cars and people may have come and gone
  Voices tall;               ///< higher: buildings, trunks and poles, which stay
  double tight = 0.0;        ///< met within 0.15 m along the other's normal
  double alike = 0.0;        ///< sum of (n . n')^2 over planar met patches
  double planar = 0.0;       ///< planar met patches
  double cells = 0.0;        ///< cells of a 10 m grid with at least 5 met patches
  double ground = 0.0;       ///< patches of the ground that lie on ground of the other
  double ground_step = 0.0;  ///< sum of their distances along the other's normal, each at most 0.2 m

  double met() const { return low.met + tall.met; }
};

constexpr std::size_t kFeatures = 20;
using Features = std::array<double, kFeatures>;
/// agreement: share of the structure that is met. presence: of what should be seen, the share that is. conflict, clash:
/// what speaks against, logarithmic. ground: how much ground is shared (logarithmic) and how far it gapes, metres.
/// lead: the correlation peak against the highest of its pair.
constexpr std::array<std::string_view, kFeatures> kFeatureNames = {
    "agreement",    "low_presence", "low_conflict", "low_clash", "tall_presence", "tall_conflict", "tall_clash",
    "explained",    "normals",      "tightness",    "residual",  "peak",          "lead",          "support",
    "tall_support", "spread",       "constraint",   "ground",    "ground_gap",    "near"};

/// A feature by its name.
constexpr double feature(const Features& features, std::string_view name) {
  std::size_t i = 0;
  while (kFeatureNames[i] != name) {
    ++i;
  }
  return features[i];
}

/// The height of a hypothesis's correlation peak (0 where it has none), and of the highest of the same pair.
struct PeakHeights {
  double own = 0.0;
  double highest = 0.0;
};

constexpr std::size_t kAllAsked = 2000;  ///< patches of structure that are asked where time does not press

/// A viewpoint, turned round once for all points that it is asked about.
struct Witness {
  Eigen::Isometry3f T_sensor_level;
  const RangeImage* image = nullptr;
};

/// Asks two scans about motions between them. What is asked of each scan is chosen once; the scans must outlive this.
class Inquiry {
 public:
  /// `asked`: patches of structure of each scan, up to kAllAsked; of the ground a third as many.
  Inquiry(const PreparedScan::Data& source, const PreparedScan::Data& target, std::size_t asked);

  /// The features of one hypothesis: what both directions say, the alignment's residual and conditioning, its peak.
  Features features(const Alignment& alignment, const PeakHeights& peak) const;

 private:
  struct Side {
    Side(const PreparedScan::Data& scan, std::size_t asked);

    const PatchMap* map;
    std::vector<Patch> structure;
    std::vector<Patch> ground;
    std::vector<Witness> witnesses;
    double ground_stands_for = 1.0;
    double stands_for = 1.0;  ///< patches of structure (up to kAllAsked) for which each one that is asked stands
  };

  static Testimony ask(const Side& from, const Side& to, const Pose& T_to_from);
  static void ask_ground(const Side& from, const Side& to, const Eigen::Isometry3f& T, Testimony& t);

  Side source_;
  Side target_;
};

}  // namespace loopmark

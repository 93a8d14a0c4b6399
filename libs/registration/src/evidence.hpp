// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The numbers that tell a right motion from a wrong one, each independent of how the motion was found.
#pragma once

#include <array>
#include <string_view>

#include "alignment.hpp"

namespace loopmark::registration::internal {

/// What one kind of structure of one scan, moved into the other, says.
struct OverlapStatistics {
  double overlap = 0.0;       ///< surfels with a surfel of the other scan within 0.4 m
  double occluded_gap = 0.0;  ///< where the other scan's surface runs on there, though no beam of it came within 0.4 m
  double missing = 0.0;       ///< at a range at which the other's beams met something, but something else
  double free_space_violation = 0.0;  ///< where the other scan's beams passed through
  double strong_violation = 0.0;      ///< of these, where all beams around did as well
};

/// Counts of one direction; where fewer surfels than kAllAsked are asked, each counts for those it stands for.
struct VerificationStatistics {
  double structure = 0.0;          ///< surfels that stand above the ground
  OverlapStatistics low;           ///< up to 2.2 m above the ground: cars and people may have come and gone
  OverlapStatistics tall;          ///< higher: buildings, trunks and poles, which stay
  OverlapStatistics objects;       ///< of the low ones, those with nothing tall above them: cars, hedges, bins
  OverlapStatistics far;           ///< over 25 m from both sensors
  double contradicted = 0.0;       ///< cells of a 5 m grid where most is in conflict
  double tall_contradicted = 0.0;  ///< cells where most of the tall structure clashes
  double ground = 0.0;             ///< surfels of the ground that lie on ground of the other
  double ground_step = 0.0;        ///< sum of their distances along the other's normal, each at most 0.2 m

  double overlap() const { return low.overlap + tall.overlap; }
};

constexpr std::size_t kFeatures = 18;
constexpr std::size_t kWeighed = 14;  ///< of these, the first, are evidence; those behind them describe the pair
using Features = std::array<double, kFeatures>;
/// agreement: share of the structure that is met. absence, clash, conflict: what speaks against, logarithmic. objects:
/// how many are met, logarithmic. contradicted: cells, logarithmic. peak: height of the correlation peak; rise: against
/// chance's, logarithmic (not against the highest: of two places that look alike both rise, and only one leads).
/// ground: how much ground is shared (logarithmic) and how far it gapes, metres. near: of the sensors to each other.
/// fewer, more: surfels of structure of the scan that has fewer and of the other, logarithmic: how much can be asked at
/// all. fill, density_ratio_more: fine surfels in a coarse one, logarithmic, of the scan that has fewer and of the
/// other: sixteen beams leave gaps that sixty-four fill. How much tall or far structure and how many landmarks are met
/// is left out: made-up towns and real ones differ too much in it.
constexpr std::array<std::string_view, kFeatures> kFeatureNames = {"agreement",
                                                                   "low_missing",
                                                                   "tall_strong_violation",
                                                                   "object_strong_violation",
                                                                   "far_violation",
                                                                   "contradicted",
                                                                   "tall_contradicted",
                                                                   "residual",
                                                                   "objects",
                                                                   "peak",
                                                                   "rise",
                                                                   "ground",
                                                                   "ground_gap",
                                                                   "proximity",
                                                                   "structure_fewer",
                                                                   "structure_more",
                                                                   "density_ratio",
                                                                   "density_ratio_more"};

/// A feature by its name.
constexpr double feature(const Features& features, std::string_view name) {
  std::size_t i = 0;
  while (kFeatureNames[i] != name) {
    ++i;
  }
  return features[i];
}

/// The height of a hypothesis's correlation peak (0 where it has none), and of the tenth of the same pair: chance's.
struct PeakHeights {
  double own = 0.0;
  double noise_floor = 0.0;
};

constexpr std::size_t kAllAsked = 2000;  ///< surfels of structure that are asked where time does not press

/// A viewpoint, turned round once for all points that it is asked about.
struct SensorView {
  Eigen::Isometry3f T_sensor_level;
  const RangeImage* image = nullptr;
};

/// Asks two scans about motions between them. What is asked of each scan is chosen once; the scans must outlive this.
class Verifier {
 public:
  /// `asked`: surfels of structure of each scan, up to kAllAsked; of the ground a third as many.
  Verifier(const PreparedScan::Data& source, const PreparedScan::Data& target, std::size_t samples);

  /// The features of one hypothesis: what both directions say, the alignment's residual and conditioning, its peak.
  Features features(const Alignment& alignment, const PeakHeights& peak) const;

 private:
  struct Side {
    Side(const PreparedScan::Data& scan, std::size_t samples);

    const surfels::SurfelMap* map;
    const surfels::SurfelMap* coarse;
    std::vector<surfels::Surfel> structure;
    std::vector<bool> is_object;  ///< of each surfel of structure: low, and nothing tall above it
    std::vector<surfels::Surfel> ground;
    std::vector<SensorView> sensor_views;
    double density_ratio = 0.0;    ///< log of fine surfels in a coarse one
    double structure_count = 0.0;  ///< surfels of structure
    double ground_sample_weight = 1.0;
    double sample_weight = 1.0;  ///< surfels of structure (up to kAllAsked) for which each one that is asked stands
  };

  static VerificationStatistics count(const Side& from, const Side& to, const Pose& T_to_from);
  static OverlapStatistics count(const Eigen::Vector3f& moved, const Side& to);
  static void count_ground(const Side& from, const Side& to, const Eigen::Isometry3f& T, VerificationStatistics& t);

  Side source_;
  Side target_;
};

}  // namespace loopmark::registration::internal

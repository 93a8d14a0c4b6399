// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/core/point_cloud.hpp"
#include "loopmark/simulation/town.hpp"

namespace loopmark::simulation {

struct PairOptions {
  std::size_t pairs = 100;
  std::size_t negatives = 50;     ///< pairs of different places without overlap; half of them look alike
  std::string sensor = "hdl64e";  ///< of the source scans
  std::string sensor_b;           ///< of the target scans; empty: the same
  int days = 2;                   ///< the target is seen on one of so many days; 1: parked cars do not change
  double min_overlap = 0.2;       ///< symmetric overlap, spread evenly from here ...
  double max_overlap = 0.9;       ///< ... to here
  double max_distance_m = 100.0;
  bool any_yaw = true;  ///< sensors are mounted at any yaw; else they look along the street
  std::uint64_t seed = 1;
};

template <class Visitor>
void describe(Visitor& v, PairOptions& o) {
  v.field("pairs", o.pairs, "number of pairs");
  v.field("negatives", o.negatives, "pairs of different places without overlap; half of them look alike");
  v.field("sensor", o.sensor, "of the source scans");
  v.field("sensor_b", o.sensor_b, "of the target scans; empty: the same");
  v.field("days", o.days, "the target is seen on one of so many days");
  v.field("min_overlap", o.min_overlap, "least symmetric overlap");
  v.field("max_overlap", o.max_overlap, "largest symmetric overlap");
  v.field("max_distance_m", o.max_distance_m, "largest distance between two scans, metres");
  v.field("any_yaw", o.any_yaw, "sensors are mounted at any yaw");
  v.field("seed", o.seed, "another seed, other places");
}

void check(const PairOptions& options);

/// Two scans of one town with their exact motion.
struct SampledPair {
  std::size_t source = 0;  ///< numbers of the scans
  std::size_t target = 0;
  Pose T_target_source = Pose::Identity();
  double overlap = 0.0;
  double overlap_symmetric = 0.0;
};

struct PairSample {
  std::vector<SampledPair> pairs;
  std::vector<std::pair<std::size_t, std::size_t>> negatives;
  std::vector<Pose> T_town_lidar;  ///< one a scan
};

/// Receives each scan once, in order of its number. The sensor stands while it sweeps, so that scans need no
/// compensation and the motions are exact.
using ScanSink = std::function<void(std::size_t index, const PointCloud& cloud)>;

/// Draws places on the streets, renders them, and keeps pairs so that their symmetric overlap (cloud/overlap.hpp) is
/// spread evenly over seven bins. Negatives overlap by less than 0.5 %: either places far apart, or equal places of
/// two blocks that look alike. Where a bin cannot be filled (one sensor against another seldom reaches the highest) the
/// others take its share. Deterministic for a seed at any number of threads.
PairSample sample_pairs(const Town& town, const PairOptions& options, const ScanSink& sink);

}  // namespace loopmark::simulation

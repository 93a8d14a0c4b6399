// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/core/options.hpp"
#include "loopmark/odometry/options.hpp"

namespace loopmark::mapping {

struct SlamOptions {
  double keyframe_m = 2.5;        ///< a keyframe after this distance,
  double keyframe_deg = 25.0;     ///< or this turn,
  double novelty = 0.5;           ///< or when this share of the scan is not in the local map (and 0.5 m are driven)
  double keyframe_voxel_m = 0.2;  ///< one point a voxel is kept of a keyframe
  double cloud_voxel_m = 0.2;     ///< and of the cloud of the whole map
  std::string registration =
      "engine";             ///< what registers loop candidates: the engine, or a variant of the paper's pipeline
  bool close_loops = true;  ///< look for places seen before
  std::size_t loop_candidates = 2;     ///< places tried for each keyframe
  double loop_every_m = 5.0;           ///< places are looked up once in this distance
  double loop_gap_m = 40.0;            ///< a place passed within this distance of driving is no loop
  double max_loop_m = 25.0;            ///< places seen from farther apart add error, not knowledge, within a segment
  double min_loop_p = 0.9;             ///< a loop below this P(correct) is kept as evidence but not used
  std::size_t recovery_keyframes = 3;  ///< latest keyframes that a lost scan is registered to
  double max_gap_s = 2.0;  ///< a longer gap between scans (and ten times the usual one) starts a new segment
  std::size_t segment_candidates = 8;  ///< more pairs of places tried for each part of the map that nothing joins
  std::size_t submap_keyframes = 5;    ///< keyframes joined into a submap for these
  double drift_m_per_m = 0.003;        ///< odometry's drift as believed by the pose graph: metres a metre
  double drift_deg_per_m = 0.01;       ///< and degrees a metre
  double floor_m = 0.01;               ///< no odometry between keyframes is believed better than this
  double floor_deg = 0.03;             ///< and this
  double loop_floor_m = 0.2;           ///< no loop is believed better than this
  double loop_floor_deg = 0.3;         ///< and this
  std::size_t max_bad_scans = 10;      ///< more damaged scans end the run
  odometry::Compensation compensation = odometry::Compensation::kUnknown;  ///< unknown: measured
};

template <class Visitor>
void describe(Visitor& v, SlamOptions& o) {
  v.field("keyframe_m", o.keyframe_m, "a keyframe after this distance, metres");
  v.field("keyframe_deg", o.keyframe_deg, "or this turn, degrees");
  v.field("novelty", o.novelty, "or when this share of the scan is not in the local map");
  v.field("keyframe_voxel_m", o.keyframe_voxel_m, "one point a voxel is kept of a keyframe, metres");
  v.field("cloud_voxel_m", o.cloud_voxel_m, "and of the cloud of the whole map, metres");
  v.field(
      "registration", o.registration,
      "what registers loop candidates: engine, or a variant of the paper's pipeline whose motions the engine verifies");
  v.field("close_loops", o.close_loops, "look for places seen before");
  v.field("loop_candidates", o.loop_candidates, "places tried for each keyframe");
  v.field("loop_every_m", o.loop_every_m, "places are looked up once in this distance, metres");
  v.field("loop_gap_m", o.loop_gap_m, "a place passed within this distance of driving is no loop, metres");
  v.field("max_loop_m", o.max_loop_m,
          "places seen from farther apart add error, not knowledge, within a segment, metres");
  v.field("min_loop_p", o.min_loop_p, "a loop below this P(correct) is kept as evidence but not used");
  v.field("recovery_keyframes", o.recovery_keyframes, "latest keyframes that a lost scan is registered to");
  v.field("max_gap_s", o.max_gap_s,
          "a longer gap between scans, if it is also ten times the usual one, starts a new segment, seconds");
  v.field("segment_candidates", o.segment_candidates,
          "pairs of places tried as submaps for each part of the map that nothing joins, in each round");
  v.field("submap_keyframes", o.submap_keyframes, "keyframes joined into a submap for these");
  v.field("drift_m_per_m", o.drift_m_per_m, "odometry's drift as believed by the pose graph, metres a metre");
  v.field("drift_deg_per_m", o.drift_deg_per_m, "and degrees a metre");
  v.field("floor_m", o.floor_m, "no odometry between keyframes is believed better than this, metres");
  v.field("floor_deg", o.floor_deg, "and this, degrees");
  v.field("loop_floor_m", o.loop_floor_m, "no loop is believed better than this, metres");
  v.field("loop_floor_deg", o.loop_floor_deg, "and this, degrees");
  v.field("max_bad_scans", o.max_bad_scans, "more damaged scans end the run");
  v.choice("compensation", o.compensation,
           {{"measure", odometry::Compensation::kUnknown},
            {"compensated", odometry::Compensation::kCompensated},
            {"raw_given_times", odometry::Compensation::kRawGivenTimes},
            {"raw_clockwise", odometry::Compensation::kRawClockwise},
            {"raw_counter_clockwise", odometry::Compensation::kRawCounterClockwise}},
           "whether scans are distorted by the sensor's motion; measure: find out from the scans");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const SlamOptions& options);

}  // namespace loopmark::mapping

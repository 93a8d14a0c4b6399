// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// From records to a map's poses: needs no scan, so that it can be repeated in seconds with other loops.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/map_store/records.hpp"
#include "loopmark/mapping/options.hpp"
#include "loopmark/pose_graph/pose_graph.hpp"

namespace loopmark::mapping {

/// A scan that stands for its surroundings.
struct Keyframe {
  std::size_t number = 0;  ///< place among the keyframes; its files are named by it
  std::size_t scan = 0;
  std::size_t segment = 0;
  Pose T_segment_lidar = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of xi in T_segment_lidar * exp(xi), against the local map
  double path_m = 0.0;                     ///< driven since the start of the log
  bool recovered = false;                  ///< placed by registration to keyframes before, not by odometry
};

/// Follows the scans of a log: the distance driven, and the keyframes among them.
class DrivenPath {
 public:
  /// The next scan; appended to `keyframes` where it is one.
  void add(const map_store::ScanRecord& scan, std::vector<Keyframe>& keyframes);

 private:
  double path_m_ = 0.0;
  bool started_ = false;
  std::size_t segment_ = 0;
  Pose last_ = Pose::Identity();
};

/// The keyframes that the scan records name, in order.
std::vector<Keyframe> keyframes_of(const std::vector<map_store::ScanRecord>& scans);

/// Whether the drive has come back from `earlier` to `later`, keyframes of one segment: it went on for `gap_m`, or half
/// of that on a way that is several times as long as the line between them (a turn within a hall, or round a block).
bool is_revisit(const Keyframe& earlier, const Keyframe& later, double gap_m);

/// What became of a loop candidate.
struct LoopVerdict {
  bool accepted = false;
  std::string reason;               ///< why not, or that a person wanted it
  double weight = 0.0;              ///< in the solved graph
  double chi2 = 0.0;                ///< of its residual in the solved graph; 0 where it did not take part
  std::optional<std::size_t> edge;  ///< in the graph; nothing where it did not take part
};

struct SolvedMap {
  std::vector<Keyframe> keyframes;
  std::vector<Pose> T_map_keyframe;
  std::vector<Pose> T_map_scan;        ///< one for every scan of the log, in order
  std::vector<Matrix6d> covariance;    ///< of xi in exp(xi) * T_map_scan, for every scan
  std::vector<std::size_t> component;  ///< of every scan; 0 is the one with most keyframes: the map
  std::size_t components = 0;
  std::vector<LoopVerdict> loops;  ///< one for each loop record
  pose_graph::PoseGraph graph;
  pose_graph::PoseGraphSolution solution;
};

/// The poses of the keyframes alone: what solve_map gives, but for T_map_scan, covariance and component.
SolvedMap solve_keyframes(const std::vector<Keyframe>& keyframes, const std::vector<map_store::LoopRecord>& loops,
                          const SlamOptions& options, const pose_graph::PoseGraphOptions& graph_options,
                          const std::vector<map_store::LoopDecision>& decisions = {});

/// Odometry edges within the segments, the loops that registration is sure of, and the robust solution. Loops that
/// `decisions` veto are left out, those that they force are trusted.
/// `scans`: one for every scan of the log, in order; at least one keyframe.
SolvedMap solve_map(const std::vector<map_store::ScanRecord>& scans, const std::vector<map_store::LoopRecord>& loops,
                    const SlamOptions& options, const pose_graph::PoseGraphOptions& graph_options,
                    const std::vector<map_store::LoopDecision>& decisions = {});

}  // namespace loopmark::mapping

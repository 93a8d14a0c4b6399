// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a run remembers of every scan and every loop candidate. Each is one line of text that restores the same bytes,
/// kept in append-only files, so that a run that was killed goes on where it was.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loopmark/odometry/tracking_status.hpp"
#include "loopmark/registration/engine.hpp"

namespace loopmark::map_store {

/// How a scan got its pose.
enum class ScanState {
  kTracked,     ///< aligned to the local map
  kRecovered,   ///< tracking was lost; placed by global registration to a keyframe
  kNewSegment,  ///< tracking was lost and nothing placed it: the first scan of a new segment
  kDamaged,     ///< could not be read or used; its pose is interpolated
  kCopy         ///< the very points of the scan before it, whose pose it has
};
const char* name(ScanState state);

struct ScanRecord {
  std::size_t scan = 0;  ///< place in the log
  double stamp_s = 0.0;
  ScanState state = ScanState::kTracked;
  std::size_t segment = 0;              ///< scans of one segment are joined by odometry
  std::optional<std::size_t> keyframe;  ///< number of the keyframe made of this scan
  Pose T_segment_lidar = Pose::Identity();
  Vector6d velocity = Vector6d::Zero();  ///< a second, lidar frame
  double inlier_share = 0.0;
  double residual_m = 0.0;
  std::size_t degenerate = 0;  ///< number of degenerate directions
  odometry::Tracking tracking = odometry::Tracking::kGood;
  Matrix6d covariance = Matrix6d::Zero();  ///< of xi in T_segment_lidar * exp(xi), against the local map
  std::string problem;                     ///< of a damaged or lost scan
};

std::string to_line(const ScanRecord& record);
/// Throws InputError on a line that is none.
ScanRecord scan_from_line(const std::string& line);

/// One loop candidate with its verdict, whether accepted or not.
struct LoopRecord {
  std::size_t source = 0;  ///< keyframe numbers: the later,
  std::size_t target = 0;  ///< and the earlier one
  std::string origin;      ///< what proposed it: "place", "neighbour", "person"
  bool answered = false;   ///< the registration gave an answer
  std::string reason;      ///< why it did not
  double p_correct = 0.0;
  Pose T_target_source = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of xi in exp(xi) * T_target_source
  registration::Evidence evidence;
};

std::string to_line(const LoopRecord& record);
LoopRecord loop_from_line(const std::string& line);

}  // namespace loopmark::map_store

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A kidnap drill: tracking in a map is cut on purpose, and what the relocalizer makes of it is compared with the
/// truth.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/kidnap_benchmark/drill_plan.hpp"
#include "loopmark/localization/relocalizer.hpp"

namespace loopmark::kidnap_benchmark {

/// The scans of one drive that a drill may feed, in order.
struct DrillDrive {
  std::vector<DrillScan> scans;
  /// Reads a scan by its place in the log, with a time for every point where its log is not compensated. Called from
  /// several threads; may throw InputError on a damaged scan, which is then left out.
  std::function<Scan(std::size_t scan)> read;
};

/// All that the events of a drill have in common.
struct DrillStage {
  std::shared_ptr<const localization::PlaceMap> map;
  DrillDrive run;    ///< tracked before the cut
  DrillDrive other;  ///< another drive, if there is one
  localization::RelocalizationOptions relocalization;
  odometry::OdometryOptions odometry;
  odometry::Compensation compensation =
      odometry::Compensation::kCompensated;  ///< of all scans: kCompensated or kRawGivenTimes
};

enum class DrillVerdict {
  kRecovered,  ///< the first pose given is right and stays right
  kWrong,      ///< a wrong pose was given
  kNone        ///< no pose was given until the event ended
};
const char* name(DrillVerdict verdict);

struct DrillOutcome {
  DrillVerdict verdict = DrillVerdict::kNone;
  bool tracked_before = false;           ///< the place was known when tracking was cut
  bool noticed = false;                  ///< the place that was known was given up
  double seconds = 0.0;                  ///< from the first scan behind the cut to the first pose (or to the end)
  double driven_m = 0.0;                 ///< the same in metres
  std::size_t scan = 0;                  ///< that was placed, in its log; where it was wrong, the first wrong one
  double p_correct = 0.0;                ///< that was said of it
  PoseError error;                       ///< of it
  Pose T_map_truth = Pose::Identity();   ///< where that scan was
  Pose T_map_answer = Pose::Identity();  ///< where it was said to be
  std::string reason;                    ///< the last thing said where no pose was given
};

/// Success: a right pose within the time allowed, and no wrong one.
bool succeeded(const DrillOutcome& outcome, const DrillOptions& options);

/// Follows the run up to the cut, goes on behind it and watches. Depends on nothing but its arguments.
DrillOutcome run_event(const DrillStage& stage, const DrillEvent& event, const DrillOptions& options);

}  // namespace loopmark::kidnap_benchmark

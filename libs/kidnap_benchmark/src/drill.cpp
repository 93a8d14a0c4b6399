// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/kidnap_benchmark/drill.hpp"

#include <optional>
#include <utility>

#include "loopmark/core/error.hpp"

namespace loopmark::kidnap_benchmark {
namespace {

/// Follows the run for a while, from a pose that is known, up to the cut. Whether it was tracked then.
bool track_before(const DrillStage& stage, const DrillEvent& event, const DrillOptions& options,
                  localization::Relocalizer& relocalizer) {
  const std::vector<DrillScan>& scans = stage.run.scans;
  std::size_t first = event.before;
  while (first > 0 && scans[event.before].stamp_s - scans[first].stamp_s < options.before_s) {
    --first;
  }
  relocalizer.place(scans[first].T_map_lidar);
  bool tracked = false;
  for (std::size_t i = first; i <= event.before; ++i) {
    try {
      tracked = relocalizer.add(stage.run.read(scans[i].scan)).state == localization::RelocalizationState::kTracking;
    } catch (const InputError&) {
      continue;
    }
  }
  return tracked;
}

/// What is made of the scans behind the cut.
class Watch {
 public:
  explicit Watch(const DrillOptions& options) : options_(options) {}

  /// Takes in one answer; false when the event is decided.
  bool take(const localization::RelocalizedScan& answer, const Pose& truth, double seconds, double driven_m) {
    outcome_.noticed = outcome_.noticed || answer.given_up;
    if (!found_at_) {
      outcome_.seconds = seconds;
      outcome_.driven_m = driven_m;
      outcome_.reason = answer.reason;
    }
    if (!answer.answered) {
      return !(found_at_ && seconds - *found_at_ >= options_.settle_s);
    }
    const PoseError error = pose_error(answer.T_map_lidar, truth);
    const bool right = error.translation_m < options_.right_m && error.rotation_deg < options_.right_deg;
    if (!found_at_ || !right) {
      outcome_.scan = answer.scan;
      outcome_.p_correct = answer.p_correct;
      outcome_.error = error;
      outcome_.T_map_truth = truth;
      outcome_.T_map_answer = answer.T_map_lidar;
      outcome_.reason.clear();
    }
    found_at_ = found_at_.value_or(seconds);
    outcome_.verdict = right ? DrillVerdict::kRecovered : DrillVerdict::kWrong;
    return right && seconds - *found_at_ < options_.settle_s;
  }

  bool found() const { return found_at_.has_value(); }
  const DrillOutcome& outcome() const { return outcome_; }

 private:
  const DrillOptions& options_;
  DrillOutcome outcome_;
  std::optional<double> found_at_;
};

Scan disturbed(Scan scan, const DrillEvent& event, double stamp_s) {
  scan.stamp_s = stamp_s;
  if (event.yaw_deg != 0.0) {
    scan.cloud = transformed(scan.cloud, pose_from_yaw(event.yaw_deg * M_PI / 180.0));
  }
  return scan;
}

}  // namespace

const char* name(DrillVerdict verdict) {
  switch (verdict) {
    case DrillVerdict::kRecovered:
      return "recovered";
    case DrillVerdict::kWrong:
      return "wrong";
    case DrillVerdict::kNone:
      break;
  }
  return "none";
}

bool succeeded(const DrillOutcome& outcome, const DrillOptions& options) {
  return outcome.verdict == DrillVerdict::kRecovered && outcome.seconds <= options.within_s;
}

DrillOutcome run_event(const DrillStage& stage, const DrillEvent& event, const DrillOptions& options) {
  localization::Relocalizer relocalizer(stage.map, stage.relocalization, stage.odometry, stage.compensation);
  const bool tracked = track_before(stage, event, options, relocalizer);
  const DrillDrive& drive = event.disturbance == Disturbance::kOtherDrive ? stage.other : stage.run;
  const double cut_s = stage.run.scans[event.before].stamp_s;
  const double first_s = drive.scans[event.after].stamp_s;
  const Pose T_lidar_turned = pose_from_yaw(-event.yaw_deg * M_PI / 180.0);
  Watch watch(options);
  double driven_m = 0.0;
  for (std::size_t i = event.after; i < drive.scans.size(); ++i) {
    const double seconds = drive.scans[i].stamp_s - first_s;
    if (seconds > options.limit_s && !watch.found()) {
      break;
    }
    if (i > event.after) {
      driven_m += (drive.scans[i].T_map_lidar.translation() - drive.scans[i - 1].T_map_lidar.translation()).norm();
    }
    std::optional<Scan> scan;
    try {
      scan = disturbed(drive.read(drive.scans[i].scan), event, cut_s + event.outage_s + seconds);
    } catch (const InputError&) {
      continue;
    }
    if (!watch.take(relocalizer.add(*scan), drive.scans[i].T_map_lidar * T_lidar_turned, seconds, driven_m)) {
      break;
    }
  }
  DrillOutcome outcome = watch.outcome();
  outcome.tracked_before = tracked;
  return outcome;
}

}  // namespace loopmark::kidnap_benchmark

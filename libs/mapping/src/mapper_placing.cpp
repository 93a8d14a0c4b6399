// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Where a scan goes: on behind the last one, back into the segment that lost it, or into a new segment.
#include <algorithm>
#include <cmath>
#include <functional>

#include "loopmark/io/drive_log.hpp"
#include "loopmark/storage/files.hpp"
#include "mapper_placed.hpp"

namespace loopmark::mapping {
namespace {

constexpr std::size_t kLeastPoints = 100;  // of a scan that can be used, after thinning
constexpr double kWorthAgreeing = 0.05;    // P(correct) of an answer that another one may confirm

bool same_place(const Pose& a, const Pose& b) {
  const PoseError error = pose_error(a, b);
  return error.translation_m < 1.0 && error.rotation_deg < 5.0;
}

/// Registers a prepared scan to the latest keyframes of the last segment, until `enough` says so of an answer.
bool registers(const registration::PairRegistration& registrar, const map_store::RunFolder& folder,
               const std::vector<Keyframe>& keyframes, const SlamOptions& options,
               const registration::PreparedCloud& source,
               const std::function<bool(const Pose& T_segment_lidar, double p_correct)>& enough) {
  for (std::size_t back = 0; back < options.recovery_keyframes && back < keyframes.size(); ++back) {
    const Keyframe& keyframe = keyframes[keyframes.size() - 1 - back];
    if (keyframe.segment != keyframes.back().segment) {
      break;
    }
    const registration::RegistrationResult result =
        registrar.align(source, *registration::restore_file(registrar, folder.keyframe(keyframe.number, "prepared")));
    const bool worth = result.answered || result.p_correct >= kWorthAgreeing;
    if (worth && enough(keyframe.T_segment_lidar * result.T_target_source, result.p_correct)) {
      return true;
    }
  }
  return false;
}

}  // namespace

/// Tracks the scan; a lost one is registered to the latest keyframes; one that fits nowhere starts a new segment, and
/// so does one behind a long gap, which no motion model reaches across, unless registration confirms it.
Mapper::Placed Mapper::place(const Scan& scan) {
  Placed placed{odometry_.track(scan), map_store::ScanState::kTracked, "", ""};
  if (placed.tracked.sample.size() < kLeastPoints) {
    throw io::DamagedScan("scan " + std::to_string(scan.index) + ": only " +
                          std::to_string(placed.tracked.sample.size()) + " usable points");
  }
  if (keyframes_.empty()) {
    placed.state = map_store::ScanState::kNewSegment;
  } else if (after_gap(scan.stamp_s)) {
    flush_pending();  // what is registered to must be there
    // The sensor may have stood still: odometry is believed where registration, which does not know of it, agrees.
    const bool confirmed =
        registrar_ && placed.tracked.tracking_status.tracking != odometry::Tracking::kLost &&
        registers(*registrar_, folder_, keyframes_, options_.slam,
                  *registrar_->prepare(odometry_.deskewed_cloud(scan, placed.tracked.sweep_velocity)),
                  [&](const Pose& pose, double) { return same_place(pose, placed.tracked.T_map_lidar); });
    if (!confirmed) {
      start_segment(scan, "a gap between the scans", placed);
    }
  } else if (placed.tracked.tracking_status.tracking == odometry::Tracking::kLost) {
    flush_pending();
    placed.problem = placed.tracked.tracking_status.reason;
    if (recover(scan, placed)) {
      placed.state = map_store::ScanState::kRecovered;
    } else {
      start_segment(scan, placed.problem, placed);
    }
  } else {
    check_odometry(scan, placed);
  }
  return placed;
}

/// Whether the gap to the last good scan is long, both in seconds and against those before. Stamps that jump back are a
/// gap, too.
bool Mapper::after_gap(double stamp_s) const {
  constexpr std::size_t kRemembered = 20;
  constexpr std::size_t kLeastKnown = 5;
  constexpr double kTimesUsual = 10.0;
  std::vector<double> stamps;
  for (auto scan = scans_.rbegin(); scan != scans_.rend() && stamps.size() <= kRemembered; ++scan) {
    if (scan->state != map_store::ScanState::kDamaged) {
      stamps.push_back(scan->stamp_s);
    }
  }
  std::vector<double> gaps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    gaps.push_back(std::abs(stamps[i - 1] - stamps[i]));
  }
  if (gaps.size() < kLeastKnown) {
    return false;
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return std::abs(stamp_s - stamps.front()) > std::max(options_.slam.max_gap_s, kTimesUsual * *middle);
}

/// The new segment starts where the motion so far would have led: a guess that nothing else rests on.
void Mapper::start_segment(const Scan& scan, const std::string& problem, Placed& placed) {
  const auto last = std::find_if(scans_.rbegin(), scans_.rend(), [](const map_store::ScanRecord& s) {
    return s.state != map_store::ScanState::kDamaged;
  });
  const double ahead_s = std::clamp(scan.stamp_s - last->stamp_s, 0.0, options_.slam.max_gap_s);
  odometry_.restart(last->T_segment_lidar * exp_se3(ahead_s * last->velocity));
  placed.tracked = odometry_.track(scan);
  placed.state = map_store::ScanState::kNewSegment;
  placed.problem = problem;
  ++segment_;
}

/// Global registration to the latest keyframes of the segment: two answers that agree, even if neither is sure by
/// itself (what deceives a registration moves along with the sensor, and so says different places for different
/// keyframes), or a sure one where the segment has no second keyframe.
bool Mapper::recover(const Scan& scan, Placed& placed) const {
  if (!registrar_) {
    return false;
  }
  const bool only_one = keyframes_.size() < 2 || keyframes_[keyframes_.size() - 2].segment != segment_ ||
                        options_.slam.recovery_keyframes < 2;
  std::vector<Pose> answers;
  const registration::PreparedCloudPtr source =
      registrar_->prepare(odometry_.deskewed_cloud(scan, placed.tracked.sweep_velocity));
  return registers(*registrar_, folder_, keyframes_, options_.slam, *source, [&](const Pose& pose, double p_correct) {
    const bool agrees =
        std::any_of(answers.begin(), answers.end(), [&](const Pose& other) { return same_place(pose, other); });
    if (agrees || (only_one && p_correct >= options_.slam.min_loop_p)) {
      placed.tracked = odometry_.track_from(scan, pose);
      if (!same_place(placed.tracked.T_map_lidar, pose)) {
        placed.tracked.T_map_lidar = pose;  // the local map draws it elsewhere: believe the registration
      }
      return true;
    }
    answers.push_back(pose);
    return false;
  });
}

}  // namespace loopmark::mapping

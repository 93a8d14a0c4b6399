// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Odometry that may have slid is held against registration: few points that fit, or a direction that nothing holds.
#include <cstdio>

#include "mapper_placed.hpp"

namespace loopmark::mapping {
namespace {

constexpr double kSamePlace_m = 0.3;  ///< within which registration and odometry say the same
constexpr double kSamePlace_deg = 2.0;

bool says_the_same(const Pose& a, const Pose& b) {
  const PoseError error = pose_error(a, b);
  return error.translation_m < kSamePlace_m && error.rotation_deg < kSamePlace_deg;
}

std::string slid_text(const Pose& tracked, const Pose& registered) {
  const PoseError error = pose_error(tracked, registered);
  char text[128];
  std::snprintf(text, sizeof text, "odometry slid: registration places it %.2f m and %.1f deg from there",
                error.translation_m, error.rotation_deg);
  return text;
}

}  // namespace

/// Whether odometry by itself cannot be believed: few points fit, or a direction is not held. Where all but that
/// direction fits, only keyframes are checked, which all other scans rest on.
bool Mapper::doubtful(const odometry::TrackedScan& tracked) const {
  const odometry::TrackingStatus& status = tracked.tracking_status;
  const bool unheld = !status.degenerate_directions.empty();
  const bool few = status.few_fit || (unheld && status.inlier_share < options_.odometry.min_inlier_share);
  return few || (unheld && deserves_keyframe(tracked, map_store::ScanState::kTracked));
}

/// Accepts, replaces or doubts the pose that odometry found, by the latest keyframes of the segment: verified where it
/// is, else registered with no guess.
void Mapper::check_odometry(const Scan& scan, Placed& placed) {
  if (!registrar_ || keyframes_.back().segment != segment_ || !doubtful(placed.tracked)) {
    return;
  }
  flush_pending();  // what is registered to must be there
  const registration::PreparedCloudPtr source =
      registrar_->prepare(odometry_.deskewed_cloud(scan, placed.tracked.sweep_velocity));
  const Keyframe& keyframe = keyframes_.back();
  const registration::PreparedCloudPtr target =
      registration::restore_file(*registrar_, folder_.keyframe(keyframe.number, "prepared"));
  const Pose T_keyframe_lidar = keyframe.T_segment_lidar.inverse() * placed.tracked.T_map_lidar;
  const registration::RegistrationResult verified = registrar_->verify(*source, *target, T_keyframe_lidar);
  if (verified.p_correct >= options_.slam.min_loop_p && says_the_same(verified.T_target_source, T_keyframe_lidar)) {
    return;
  }
  for (std::size_t back = 0; back < options_.slam.recovery_keyframes && back < keyframes_.size(); ++back) {
    const Keyframe& other = keyframes_[keyframes_.size() - 1 - back];
    if (other.segment != segment_) {
      break;
    }
    const registration::RegistrationResult found = registrar_->align(
        *source, *registration::restore_file(*registrar_, folder_.keyframe(other.number, "prepared")));
    if (found.answered && found.p_correct >= options_.slam.min_loop_p) {
      believe_registration(scan, other.T_segment_lidar * found.T_target_source, placed);
      return;
    }
  }
  placed.doubt = "few points fit or a direction is not held, and registration does not confirm it";
}

void Mapper::believe_registration(const Scan& scan, const Pose& T_segment_lidar, Placed& placed) const {
  if (says_the_same(T_segment_lidar, placed.tracked.T_map_lidar)) {
    return;
  }
  placed.problem = slid_text(placed.tracked.T_map_lidar, T_segment_lidar);
  placed.state = map_store::ScanState::kRecovered;
  placed.tracked = odometry_.track_from(scan, T_segment_lidar);
  if (!says_the_same(placed.tracked.T_map_lidar, T_segment_lidar)) {
    placed.tracked.T_map_lidar = T_segment_lidar;  // the local map draws it back to where it slid
  }
}

}  // namespace loopmark::mapping

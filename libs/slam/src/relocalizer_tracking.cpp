// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How a relocalizer follows a place that it knows, and how it notices that it is elsewhere.
#include <algorithm>
#include <cmath>

#include "place_comparison.hpp"
#include "relocalizer_state.hpp"

namespace loopmark {
namespace {

constexpr double kMisfitOdds = 1.5;     ///< taken from the log-odds of a place by a scan that does not fit the map
constexpr double kMostOfOneScan = 4.0;  ///< log-odds that one verification may add or take
constexpr double kUsualMemory = 0.9;    ///< of the usual share of fitting keypoints, a scan

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace

void Relocalizer::begin_tracking(const Pose& T_map_odometry, const Pose& T_odometry_lidar, double log_odds) {
  State& s = *state_;
  s.tracking = true;
  s.in_doubt = false;
  s.outdone = false;
  s.T_map_odometry = T_map_odometry;
  s.log_odds = std::min(log_odds, kMostLogOdds);
  s.misfits = 0;
  s.usual_share = 0.0;
  s.last_in_map.reset();
  s.verified_at.reset();
  s.compared_at = T_odometry_lidar;
}

/// Aligns the scan to the map from where the own motion predicts it, and has registration judge the pose now and then.
/// `just_found`: this scan itself was searched, and the place is what came of it.
void Relocalizer::track(const Scan& scan, const TrackedScan& tracked, bool just_found, RelocalizedScan& answer) {
  State& s = *state_;
  const Pose predicted = s.T_map_odometry * tracked.T_map_lidar;
  const PointCloud cloud = s.odometry.deskewed_cloud(scan, tracked.velocity);
  const Alignment found = s.align_to_map(cloud, predicted);
  const PoseError jump = pose_error(found.T_map_lidar, predicted);
  const double share = found.health.inlier_share;
  bool fits = share >= s.options.min_inlier_share && jump.translation_m <= s.options.max_jump_m &&
              jump.rotation_deg <= s.options.same_place_deg;
  s.in_doubt = s.in_doubt || (!just_found && s.doubtful(share, jump));
  Pose T_map_lidar = found.T_map_lidar;
  bool elsewhere = false;
  if (fits && just_found) {
    const bool apart = jump.translation_m > kDisagreementM;
    T_map_lidar = apart ? verified(cloud, tracked, found.T_map_lidar) : found.T_map_lidar;
    fits = !apart || s.verdict >= 0.0;
  } else if (fits && (s.in_doubt || s.is_due(s.compared_at, tracked, s.compare_after_m()))) {
    const PlaceComparison said = compared(cloud, tracked, T_map_lidar);
    fits = !s.in_doubt;
    elsewhere = s.in_doubt && said.verdict == PlaceComparison::Verdict::kElsewhere;
  } else if (fits && s.is_due(s.verified_at, tracked, s.options.verify_every_m)) {
    T_map_lidar = verified(cloud, tracked, found.T_map_lidar);
  }
  answer.inlier_share = share;
  if (fits) {
    s.misfits = 0;
    s.usual_share = s.usual_share == 0.0 ? share : kUsualMemory * s.usual_share + (1.0 - kUsualMemory) * share;
    s.T_map_odometry = T_map_lidar * tracked.T_map_lidar.inverse();
    s.mend_own_motion(tracked, T_map_lidar, predicted);
  } else {
    T_map_lidar = predicted;
    s.last_in_map.reset();
    ++s.misfits;
    s.log_odds -= kMisfitOdds;
  }
  answer.p_correct = probability(s.log_odds);
  if (elsewhere || s.misfits >= s.options.lost_after || answer.p_correct < s.options.min_p_correct) {
    lose(fits        ? "registration says that this is another place"
         : elsewhere ? "it looks like another place of the map"
                     : "scans no longer fit the map",
         answer);
    return;
  }
  answer.state = RelocalizationState::kTracking;
  answer.answered = fits;
  answer.reason = fits ? answer.reason : "the scan does not fit the map";
  answer.T_map_lidar = T_map_lidar;
  const Matrix6d to_map = adjoint(answer.T_map_lidar);
  answer.covariance = to_map * found.health.covariance * to_map.transpose();
}

/// The poses between which registration has to choose: where own motion leads elsewhere than nearest points do (walls
/// let a scan slide along a street), both.
std::vector<Pose> Relocalizer::State::in_question(const TrackedScan& tracked, const Pose& T_map_lidar) const {
  const Pose predicted = T_map_odometry * tracked.T_map_lidar;
  const bool apart = pose_error(T_map_lidar, predicted).translation_m > kDisagreementM;
  return apart ? std::vector<Pose>{T_map_lidar, predicted} : std::vector<Pose>{T_map_lidar};
}

/// One more piece of evidence for or against the place, from beams and structure rather than from nearest points.
/// Returns the pose, or that of registration where it is apart; `s.verdict` is what registration says of it.
Pose Relocalizer::verified(const PointCloud& cloud, const TrackedScan& tracked, const Pose& T_map_lidar) {
  State& s = *state_;
  s.verified_at = tracked.T_map_lidar;
  s.verdict = -kMostOfOneScan;
  const std::vector<Pose> believed = s.in_question(tracked, T_map_lidar);
  Pose better = T_map_lidar;
  for (const PlaceAnswer& answer : s.map->judge(cloud, believed)) {
    const bool same_place = std::any_of(believed.begin(), believed.end(), [&](const Pose& pose) {
      return say_the_same(answer.T_map_lidar, pose, s.options);
    });
    if (same_place && answer.log_odds > s.verdict) {
      s.verdict = answer.log_odds;
      better = unless_apart(T_map_lidar, answer.T_map_lidar);
    }
  }
  s.log_odds = std::min(s.log_odds + s.options.repeat_weight * std::min(s.verdict, kMostOfOneScan), kMostLogOdds);
  return better;
}

/// Asks the whole map about the scan: a place that looks like another one is told from it by nothing that tracking
/// does. In doubt, what was known of the place counts no more than own motion does; the doubt ends where the place
/// holds. Else the scan is one more piece of evidence, and where another place fits better, the next ones are asked
/// soon. Moves the pose where registration has it elsewhere about the place.
PlaceComparison Relocalizer::compared(const PointCloud& cloud, const TrackedScan& tracked, Pose& T_map_lidar) {
  State& s = *state_;
  s.verified_at = tracked.T_map_lidar;
  s.compared_at = tracked.T_map_lidar;
  s.searched = s.map->search(cloud, s.options.places, s.in_question(tracked, T_map_lidar));
  const PlaceComparison said = compare_places(*s.searched, T_map_lidar, s.options);
  s.outdone = said.lead < 0.0;
  if (said.verdict == PlaceComparison::Verdict::kHolds) {
    const Pose better = unless_apart(T_map_lidar, said.here.T_map_lidar);
    T_map_lidar = s.in_doubt ? settled(tracked, T_map_lidar, better) : better;
  }
  if (!s.in_doubt) {
    const double lead = std::clamp(said.lead, -kMostOfOneScan, kMostOfOneScan);
    s.log_odds = std::min(s.log_odds + s.options.repeat_weight * lead, kMostLogOdds);
  } else if (said.verdict == PlaceComparison::Verdict::kHolds) {
    s.log_odds = std::min(said.log_odds, kMostLogOdds);
    s.in_doubt = false;
    s.usual_share = 0.0;  // what fits from here on is usual
  }
  return said;
}

/// `better`, where registration has the sensor, without what a wrong motion has done to a raw scan: where the two poses
/// are not one, own motion was wrong, and begins anew with what the map says of it.
Pose Relocalizer::settled(const TrackedScan& tracked, const Pose& T_map_lidar, const Pose& better) {
  State& s = *state_;
  if (pose_error(T_map_lidar, better).translation_m <= kDisagreementM) {
    return better;
  }
  const std::optional<SweepInMap> found = s.sweep_in_map(tracked, better);
  if (!found || !say_the_same(found->T_map_lidar, better, s.options)) {
    return better;
  }
  s.begin_own_motion(tracked, found->velocity);
  return found->T_map_lidar;
}

}  // namespace loopmark

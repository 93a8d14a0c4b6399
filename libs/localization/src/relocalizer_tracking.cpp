// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How a relocalizer follows a place that it knows, and how it notices that it is elsewhere.
#include <algorithm>
#include <cmath>

#include "place_comparison.hpp"
#include "relocalizer_state.hpp"

namespace loopmark::localization {
namespace {

constexpr double kMisfitOdds = 1.5;     ///< taken from the log-odds of a place by a scan that does not fit the map
constexpr double kMostOfOneScan = 4.0;  ///< log-odds that one verification may add or take
constexpr double kUsualMemory = 0.9;    ///< of the usual share of fitting keypoints, a scan

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace

void Relocalizer::begin_tracking(const Pose& T_map_odometry, const Pose& T_odometry_lidar, double log_odds) {
  State& s = *state_;
  s.tracking = true;
  s.verification_pending = false;
  s.overtaken = false;
  s.T_map_odometry = T_map_odometry;
  s.log_odds = std::min(log_odds, kMostLogOdds);
  s.misfits = 0;
  s.usual_share = 0.0;
  s.last_in_map.reset();
  s.verified_at.reset();
  s.compared_at = T_odometry_lidar;
}

/// Aligns the scan to the map from where the own motion predicts it, and has registration judge the pose now and then.
/// `just_found`: the place is what came of a search of this scan, or was told with it; own motion does not speak for it
/// yet.
void Relocalizer::track(const Scan& scan, const odometry::TrackedScan& tracked, bool just_found,
                        RelocalizedScan& answer) {
  State& s = *state_;
  const PointCloud cloud = s.odometry.deskewed_cloud(scan, tracked.sweep_velocity);
  Followed followed = s.followed(cloud, s.T_map_odometry * tracked.T_map_lidar);
  s.verification_pending = s.verification_pending || (!just_found && s.doubtful(followed));
  if (followed.fits) {
    examine(cloud, tracked, just_found, followed);
  }
  s.remember(tracked, followed);
  answer.inlier_share = followed.tracking_status.inlier_share;
  answer.p_correct = probability(s.log_odds);
  if (followed.elsewhere || s.misfits >= s.options.lost_after || answer.p_correct < s.options.min_p_correct) {
    lose(followed.reason, answer);
    return;
  }
  answer.state = RelocalizationState::kTracking;
  answer.answered = followed.fits;
  answer.reason = followed.fits ? answer.reason : followed.reason;
  answer.T_map_lidar = followed.T_map_lidar;
  const Matrix6d to_map = adjoint(answer.T_map_lidar);
  answer.covariance = to_map * followed.tracking_status.covariance * to_map.transpose();
}

Followed Relocalizer::State::followed(const PointCloud& cloud, const Pose& predicted) {
  const odometry::Alignment found = align_to_map(cloud, predicted);
  Followed result;
  result.predicted = predicted;
  result.T_map_lidar = found.T_map_lidar;
  result.jump = pose_error(found.T_map_lidar, predicted);
  result.tracking_status = found.tracking_status;
  result.fits = found.tracking_status.inlier_share >= options.min_inlier_share &&
                result.jump.translation_m <= options.max_jump_m && result.jump.rotation_deg <= options.same_place_deg;
  result.reason = result.fits ? "registration says that this is another place" : "the scan does not fit the map";
  return result;
}

/// Asks registration about a scan that fits: the whole map in doubt and now and then, else the place alone.
void Relocalizer::examine(const PointCloud& cloud, const odometry::TrackedScan& tracked, bool just_found,
                          Followed& followed) {
  State& s = *state_;
  const bool apart = followed.jump.translation_m > kDisagreementM;
  if (just_found) {
    if (apart || !s.verified_at) {
      followed.T_map_lidar = verified(cloud, tracked, followed.T_map_lidar);
      followed.fits = !apart || s.verdict >= 0.0;
    }
  } else if (s.verification_pending || s.is_due(s.compared_at, tracked, s.compare_after_m())) {
    const internal::PlaceComparison said = compared(cloud, tracked, followed.T_map_lidar);
    followed.fits = !s.verification_pending;
    followed.elsewhere = s.verification_pending && said.verdict == internal::PlaceComparison::Verdict::kElsewhere;
    followed.reason = "other places of the map look like this";
  } else if (s.is_due(s.verified_at, tracked, s.options.verify_every_m)) {
    followed.T_map_lidar = verified(cloud, tracked, followed.T_map_lidar);
  }
}

void Relocalizer::State::remember(const odometry::TrackedScan& tracked, Followed& followed) {
  if (!followed.fits) {
    followed.T_map_lidar = followed.predicted;
    last_in_map.reset();
    ++misfits;
    log_odds -= kMisfitOdds;
    return;
  }
  const double share = followed.tracking_status.inlier_share;
  misfits = 0;
  usual_share = usual_share == 0.0 ? share : kUsualMemory * usual_share + (1.0 - kUsualMemory) * share;
  T_map_odometry = followed.T_map_lidar * tracked.T_map_lidar.inverse();
  reset_odometry(tracked, followed.T_map_lidar, followed.predicted);
}

/// The poses between which registration has to choose: where own motion leads elsewhere than nearest points do (walls
/// let a scan slide along a street), both.
std::vector<Pose> Relocalizer::State::in_question(const odometry::TrackedScan& tracked, const Pose& T_map_lidar) const {
  const Pose predicted = T_map_odometry * tracked.T_map_lidar;
  const bool apart = pose_error(T_map_lidar, predicted).translation_m > kDisagreementM;
  return apart ? std::vector<Pose>{T_map_lidar, predicted} : std::vector<Pose>{T_map_lidar};
}

/// One more segment of evidence for or against the place, from beams and structure rather than from nearest points.
/// Returns the pose, or that of registration where it is apart; `s.verdict` is what registration says of it.
Pose Relocalizer::verified(const PointCloud& cloud, const odometry::TrackedScan& tracked, const Pose& T_map_lidar) {
  State& s = *state_;
  s.verified_at = tracked.T_map_lidar;
  s.verdict = -kMostOfOneScan;
  const std::vector<Pose> priors = s.in_question(tracked, T_map_lidar);
  Pose better = T_map_lidar;
  for (const LocalizationHypothesis& answer : s.map->judge(cloud, priors)) {
    const bool same_place = std::any_of(priors.begin(), priors.end(),
                                        [&](const Pose& pose) { return agree(answer.T_map_lidar, pose, s.options); });
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
/// holds. Else the scan is one more segment of evidence, and where another place fits better, the next ones are asked
/// soon. Moves the pose where registration has it elsewhere about the place.
internal::PlaceComparison Relocalizer::compared(const PointCloud& cloud, const odometry::TrackedScan& tracked,
                                                Pose& T_map_lidar) {
  State& s = *state_;
  s.verified_at = tracked.T_map_lidar;
  s.compared_at = tracked.T_map_lidar;
  s.searched = s.map->search(cloud, s.options.places, s.in_question(tracked, T_map_lidar));
  const internal::PlaceComparison said = internal::compare_places(*s.searched, T_map_lidar, s.options);
  s.overtaken = said.lead < 0.0;
  if (said.verdict == internal::PlaceComparison::Verdict::kHolds) {
    const Pose better = unless_apart(T_map_lidar, said.here.T_map_lidar);
    T_map_lidar = s.verification_pending ? settled(tracked, T_map_lidar, better) : better;
  }
  if (!s.verification_pending) {
    const double lead = std::clamp(said.lead, -kMostOfOneScan, kMostOfOneScan);
    s.log_odds = std::min(s.log_odds + s.options.repeat_weight * lead, kMostLogOdds);
  } else if (said.verdict == internal::PlaceComparison::Verdict::kHolds) {
    s.log_odds = std::min(said.log_odds, kMostLogOdds);
    s.verification_pending = false;
    s.usual_share = 0.0;  // what fits from here on is usual
  }
  return said;
}

/// `better`, where registration has the sensor, without what a wrong motion has done to a raw scan: where the two poses
/// are not one, own motion was wrong, and begins anew with what the map says of it.
Pose Relocalizer::settled(const odometry::TrackedScan& tracked, const Pose& T_map_lidar, const Pose& better) {
  State& s = *state_;
  if (pose_error(T_map_lidar, better).translation_m <= kDisagreementM) {
    return better;
  }
  const std::optional<internal::SweepInMap> found = s.sweep_in_map(tracked, better);
  if (!found || !agree(found->T_map_lidar, better, s.options)) {
    return better;
  }
  s.begin_odometry(tracked, found->velocity);
  return found->T_map_lidar;
}

}  // namespace loopmark::localization

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "relocalizer_state.hpp"
#include "sweep_motion.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kLeastPoints = 100;  ///< of a scan that can be used
constexpr double kMisfitOdds = 1.5;        ///< taken from the log-odds of a place by a scan that does not fit the map
constexpr double kMostOfOneScan = 4.0;     ///< log-odds that one verification may add or take
constexpr double kMaxLogOdds = 9.0;
constexpr double kWorthCorrecting = -2.0;  ///< log-odds of an answer to a distorted scan
constexpr std::size_t kRivals = 6;         ///< answers to a distorted scan that are judged again without the distortion
constexpr double kToldLogOdds = 3.0;       ///< of a pose that was told from outside
constexpr double kUsualMemory = 0.9;       ///< of the usual share of fitting keypoints, a scan

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace

Relocalizer::Relocalizer(std::shared_ptr<const PlaceMap> map, const RelocalizationOptions& options,
                         const OdometryOptions& odometry_options, Compensation compensation, const SweepModel& sweep) {
  check(options);
  state_ = std::make_unique<State>(std::move(map), options, odometry_options, compensation, sweep);
}

Relocalizer::~Relocalizer() = default;

void Relocalizer::place(const Pose& T_map_lidar) { state_->told = T_map_lidar; }

RelocalizedScan Relocalizer::add(const Scan& scan) {
  State& s = *state_;
  RelocalizedScan answer;
  answer.scan = scan.index;
  answer.stamp_s = scan.stamp_s;
  answer.state = s.tracking ? RelocalizationState::kTracking : RelocalizationState::kSearching;
  const TrackedScan tracked = follow_own_motion(scan, answer);
  if (tracked.sample.size() < kLeastPoints) {
    answer.reason = "the scan has too few points";
    return answer;
  }
  if (s.told) {
    begin_tracking(*s.told * tracked.T_map_lidar.inverse(), kToldLogOdds);
    s.told.reset();
  }
  if (s.tracking) {
    track(scan, tracked, answer);
  }
  if (!s.tracking) {
    search(scan, tracked, answer);
  }
  return answer;
}

/// The scan's pose in the odometry's frame. Where the motion is lost it starts anew, and the place is given up.
TrackedScan Relocalizer::follow_own_motion(const Scan& scan, RelocalizedScan& answer) {
  State& s = *state_;
  s.gap_s = s.last_stamp_s ? scan.stamp_s - *s.last_stamp_s : 0.0;
  const auto restart = [&](const std::string& reason) {
    s.odometry.restart();
    s.committed = 0;
    lose(reason, answer);
  };
  if (s.committed > 0 && (s.gap_s > s.options.max_gap_s || s.gap_s < 0.0)) {
    restart(s.gap_s < 0.0 ? "stamps go back" : "no scan came for " + std::to_string(std::lround(s.gap_s)) + " s");
  }
  TrackedScan tracked = s.odometry.track(scan);
  if (tracked.sample.size() < kLeastPoints) {
    return tracked;
  }
  if (s.committed > 0 && tracked.health.tracking == Tracking::kLost) {
    restart("the motion was lost: " + tracked.health.reason);
    tracked = s.odometry.track(scan);
  }
  s.odometry.commit(tracked);
  s.last_stamp_s = scan.stamp_s;
  ++s.committed;
  return tracked;
}

/// The first scan of a moving sensor is distorted by a motion that is not known yet: the surest answer tells it, and is
/// judged again without the distortion. Returns the motion.
Vector6d Relocalizer::correct_first_scan(const Scan& scan, const TrackedScan& tracked,
                                         std::vector<PlaceAnswer>& answers) {
  State& s = *state_;
  if (answers.empty() || answers.front().log_odds < kWorthCorrecting || !s.odometry.deskews() || s.committed != 1 ||
      tracked.sample.time_offset_s.size() != tracked.sample.size()) {
    return tracked.velocity;
  }
  PlaceAnswer& best = answers.front();
  s.renew_surroundings(best.T_map_lidar.translation());
  const auto found = align_sweep(tracked.sample.points, tracked.sample.time_offset_s, *s.around, best.T_map_lidar);
  if (!found) {
    return tracked.velocity;
  }
  judge_again(s.odometry.deskewed_cloud(scan, found->velocity), found->T_map_lidar, answers);
  TrackedScan moving = tracked;  // so that the next scan is expected where this motion leads
  moving.velocity = found->velocity;
  s.odometry.restart(tracked.T_map_lidar);
  s.odometry.commit(moving);
  return found->velocity;
}

/// Judges the surest answer without the scan's distortion, at the pose `best` that was found with the motion, and the
/// others beside it, as far as the same correction carries them: what tells places apart must be asked of the same
/// scan.
void Relocalizer::judge_again(const PointCloud& cloud, const Pose& best, std::vector<PlaceAnswer>& answers) const {
  const Pose correction = answers.front().T_map_lidar.inverse() * best;
  std::vector<Pose> believed;
  for (std::size_t i = 0; i < answers.size() && believed.size() < kRivals; ++i) {
    if (i == 0 || answers[i].log_odds >= kWorthCorrecting) {
      answers[i].T_map_lidar = answers[i].T_map_lidar * correction;
      believed.push_back(answers[i].T_map_lidar);
    }
  }
  for (const PlaceAnswer& again : state_->map->search(cloud, 0, believed)) {
    for (std::size_t i = 0; i < believed.size(); ++i) {
      const PoseError moved = pose_error(again.T_map_lidar, believed[i]);
      if (moved.translation_m < state_->options.same_place_m && moved.rotation_deg < state_->options.same_place_deg &&
          again.log_odds >= answers[i].log_odds) {
        answers[i].T_map_lidar = again.T_map_lidar;
        answers[i].log_odds = again.log_odds;
      }
    }
  }
  std::stable_sort(answers.begin(), answers.end(),
                   [](const PlaceAnswer& a, const PlaceAnswer& b) { return a.log_odds > b.log_odds; });
}

/// Registers the scan to the places that look like it and to those believed so far, unless it hardly differs from the
/// one before.
void Relocalizer::search(const Scan& scan, TrackedScan tracked, RelocalizedScan& answer) {
  State& s = *state_;
  const Pose& T_odometry_lidar = tracked.T_map_lidar;
  const bool moved =
      !s.searched_at || (s.searched_at->inverse() * T_odometry_lidar).translation().norm() >= s.options.search_every_m;
  if (moved) {
    const PointCloud cloud = s.odometry.deskewed_cloud(scan, tracked.velocity);
    std::vector<PlaceAnswer> answers = s.map->search(cloud, s.options.places, s.believed(T_odometry_lidar));
    tracked.velocity = correct_first_scan(scan, tracked, answers);
    s.beliefs.add(answers, T_odometry_lidar);
    s.searched_at = T_odometry_lidar;
  }
  const std::optional<PlaceBelief> best = s.beliefs.best();
  answer.state = answer.given_up ? RelocalizationState::kLost : RelocalizationState::kSearching;
  answer.p_correct = best ? best->p : 0.0;
  if (!best || best->p < s.options.min_p_correct || !s.beliefs.decided()) {
    const std::string why = !best                               ? "no place looks like this"
                            : best->p < s.options.min_p_correct ? "no place is probable enough"
                                                                : "two places are alike";
    answer.reason = answer.reason.empty() ? why : answer.reason;
    return;
  }
  answer.answered = true;
  answer.T_map_lidar = best->T_map_odometry * T_odometry_lidar;
  answer.covariance = best->covariance;
  if (best->p >= s.options.tracking_p) {
    begin_tracking(best->T_map_odometry, std::log(best->p / std::max(1.0 - best->p, 1e-6)));
    s.verified_at = T_odometry_lidar;
    track(scan, tracked, answer);
  }
}

void Relocalizer::begin_tracking(const Pose& T_map_odometry, double log_odds) {
  State& s = *state_;
  s.tracking = true;
  s.T_map_odometry = T_map_odometry;
  s.log_odds = std::min(log_odds, kMaxLogOdds);
  s.misfits = 0;
  s.usual_share = 0.0;
  s.last_in_map.reset();
  s.verified_at.reset();
}

/// Aligns the scan to the map from where the own motion predicts it, and has registration judge the pose now and then.
void Relocalizer::track(const Scan& scan, const TrackedScan& tracked, RelocalizedScan& answer) {
  State& s = *state_;
  const Pose predicted = s.T_map_odometry * tracked.T_map_lidar;
  const Alignment found = s.align_to_map(s.odometry.deskewed_cloud(scan, tracked.velocity), predicted);
  const PoseError jump = pose_error(found.T_map_lidar, predicted);
  const double share = found.health.inlier_share;
  bool fits = share >= s.options.min_inlier_share && jump.translation_m <= s.options.max_jump_m &&
              jump.rotation_deg <= s.options.same_place_deg;
  const bool doubtful =
      share < s.options.doubt_share * s.usual_share || s.gap_s > kGapS || jump.translation_m > kDisagreementM;
  const bool due = !s.verified_at ||
                   (s.verified_at->inverse() * tracked.T_map_lidar).translation().norm() >= s.options.verify_every_m;
  Pose T_map_lidar = found.T_map_lidar;
  if (fits && (due || doubtful)) {
    T_map_lidar = verified(scan, tracked, found.T_map_lidar);
    fits = !doubtful || s.verdict >= 0.0;
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
  if (s.misfits >= s.options.lost_after || answer.p_correct < s.options.min_p_correct) {
    lose(fits ? "registration says that this is another place" : "scans no longer fit the map", answer);
    return;
  }
  answer.state = RelocalizationState::kTracking;
  answer.answered = fits;
  answer.reason = fits ? answer.reason : "the scan does not fit the map";
  answer.T_map_lidar = T_map_lidar;
  const Matrix6d to_map = adjoint(answer.T_map_lidar);
  answer.covariance = to_map * found.health.covariance * to_map.transpose();
}

/// One more piece of evidence for or against the place, from beams and structure rather than from nearest points. Where
/// own motion leads elsewhere than nearest points do (walls let a scan slide along a street), both are judged. Returns
/// the pose, or that of registration where it is apart; `s.verdict` is what registration says of it.
Pose Relocalizer::verified(const Scan& scan, const TrackedScan& tracked, const Pose& T_map_lidar) {
  State& s = *state_;
  s.verified_at = tracked.T_map_lidar;
  s.verdict = -kMostOfOneScan;
  std::vector<Pose> believed = {T_map_lidar};
  const Pose predicted = s.T_map_odometry * tracked.T_map_lidar;
  if (pose_error(T_map_lidar, predicted).translation_m > kDisagreementM) {
    believed.push_back(predicted);
  }
  Pose better = T_map_lidar;
  for (const PlaceAnswer& answer : s.map->judge(s.odometry.deskewed_cloud(scan, tracked.velocity), believed)) {
    const bool same_place = std::any_of(believed.begin(), believed.end(), [&](const Pose& pose) {
      const PoseError off = pose_error(answer.T_map_lidar, pose);
      return off.translation_m < s.options.same_place_m && off.rotation_deg < s.options.same_place_deg;
    });
    if (same_place && answer.log_odds > s.verdict) {
      s.verdict = answer.log_odds;
      const double off_m = pose_error(answer.T_map_lidar, T_map_lidar).translation_m;
      better = off_m > kDisagreementM ? answer.T_map_lidar : T_map_lidar;
    }
  }
  s.log_odds = std::min(s.log_odds + s.options.repeat_weight * std::min(s.verdict, kMostOfOneScan), kMaxLogOdds);
  return better;
}

void Relocalizer::lose(const std::string& reason, RelocalizedScan& answer) {
  State& s = *state_;
  answer.given_up = answer.given_up || s.tracking;
  answer.reason = s.tracking ? reason : answer.reason;
  s.tracking = false;
  s.beliefs.clear();
  s.searched_at.reset();
  answer.state = answer.given_up ? RelocalizationState::kLost : RelocalizationState::kSearching;
  answer.answered = false;
}

}  // namespace loopmark

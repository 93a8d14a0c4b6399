// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "competing_hypotheses.hpp"
#include "relocalizer_state.hpp"

namespace loopmark::localization {
namespace {

constexpr std::size_t kLeastPoints = 100;  ///< of a scan that can be used
constexpr double kWorthCorrecting = -2.0;  ///< log-odds of an answer to a distorted scan
constexpr std::size_t kCompeting = 6;      ///< answers to a distorted scan that are judged again without the distortion
constexpr double kToldLogOdds = 3.0;       ///< of a pose that was told from outside

double log_of_odds(const std::vector<LocalizationHypothesis>& answers) {
  std::vector<double> each;
  for (const LocalizationHypothesis& answer : answers) {
    each.push_back(answer.log_odds);
  }
  return internal::log_of_sum(each);
}

}  // namespace

Relocalizer::Relocalizer(std::shared_ptr<const PlaceMap> map, const RelocalizationOptions& options,
                         const odometry::OdometryOptions& odometry_options, odometry::Compensation compensation,
                         const cloud::SweepModel& sweep) {
  check(options);
  state_ = std::make_unique<State>(std::move(map), options, odometry_options, compensation, sweep);
}

Relocalizer::~Relocalizer() = default;

void Relocalizer::place(const Pose& T_map_lidar) { state_->prior = T_map_lidar; }

RelocalizedScan Relocalizer::add(const Scan& scan) {
  State& s = *state_;
  RelocalizedScan answer;
  answer.scan = scan.index;
  answer.stamp_s = scan.stamp_s;
  answer.state = s.tracking ? RelocalizationState::kTracking : RelocalizationState::kSearching;
  s.searched.reset();
  const odometry::TrackedScan tracked = follow_odometry(scan, answer);
  if (tracked.sample.size() < kLeastPoints) {
    answer.reason = "the scan has too few points";
    return answer;
  }
  const bool prior = s.prior.has_value();
  if (prior) {
    begin_tracking(*s.prior * tracked.T_map_lidar.inverse(), tracked.T_map_lidar, kToldLogOdds);
    s.prior.reset();
  }
  if (s.tracking) {
    track(scan, tracked, prior, answer);
  }
  if (!s.tracking) {
    search(scan, tracked, answer);
  }
  return answer;
}

/// Where the map has told the motion of the first scan, the second one is looked for where it leads, and only if it is
/// not there, all around as an odometry has to that knows no motion yet.
odometry::TrackedScan Relocalizer::State::next_pose(const Scan& scan) {
  const std::optional<odometry::TrackedScan> first = std::exchange(first_with_motion, std::nullopt);
  if (first && gap_s > 0.0) {
    odometry::TrackedScan tracked = odometry.track_from(scan, first->T_map_lidar * exp_se3(gap_s * first->velocity));
    if (tracked.sample.size() >= kLeastPoints && tracked.tracking_status.tracking == odometry::Tracking::kGood) {
      return tracked;
    }
  }
  return odometry.track(scan);
}

/// The scan's pose in the odometry's frame. Where the motion is lost it starts anew, and the place is given up.
odometry::TrackedScan Relocalizer::follow_odometry(const Scan& scan, RelocalizedScan& answer) {
  State& s = *state_;
  s.gap_s = s.last_stamp_s ? scan.stamp_s - *s.last_stamp_s : 0.0;
  const auto restart = [&](const std::string& reason) {
    s.odometry.restart();
    s.first_with_motion.reset();
    s.committed = 0;
    lose(reason, answer);
  };
  if (s.committed > 0 && (s.gap_s > s.options.max_gap_s || s.gap_s < 0.0)) {
    restart(s.gap_s < 0.0 ? "stamps go back" : "no scan came for " + std::to_string(std::lround(s.gap_s)) + " s");
  }
  odometry::TrackedScan tracked = s.next_pose(scan);
  if (tracked.sample.size() < kLeastPoints) {
    return tracked;
  }
  if (s.committed > 0 && tracked.tracking_status.tracking == odometry::Tracking::kLost) {
    restart("the motion was lost: " + tracked.tracking_status.reason);
    tracked = s.odometry.track(scan);
  }
  s.odometry.commit(tracked);
  s.last_stamp_s = scan.stamp_s;
  ++s.committed;
  return tracked;
}

/// The first scan of a moving sensor is distorted by a motion that is not known yet, and the first one behind a gap by
/// one that is hardly known: the surest answer tells it, and is judged again without the distortion. Returns the
/// motion.
Vector6d Relocalizer::correct_first_scan(const Scan& scan, const odometry::TrackedScan& tracked,
                                         std::vector<LocalizationHypothesis>& answers) {
  State& s = *state_;
  const bool motion_is_known = s.committed > 1 && s.gap_s <= kGapS;
  if (answers.empty() || answers.front().log_odds < kWorthCorrecting || motion_is_known) {
    return tracked.sweep_velocity;
  }
  const std::optional<internal::SweepInMap> found = s.sweep_in_map(tracked, answers.front().T_map_lidar);
  if (!found) {
    return tracked.sweep_velocity;
  }
  judge_again(s.odometry.deskewed_cloud(scan, found->velocity), found->T_map_lidar, answers);
  s.begin_odometry(tracked, found->velocity);
  return found->velocity;
}

/// Judges the surest answer without the scan's distortion, at the pose `best` that was found with the motion, and the
/// others beside it, as far as the same correction carries them: which of them it is must be asked of the same scan.
/// Whether it is any of them, the distorted scan may have told better.
void Relocalizer::judge_again(const PointCloud& cloud, const Pose& best,
                              std::vector<LocalizationHypothesis>& answers) const {
  const Pose correction = answers.front().T_map_lidar.inverse() * best;
  std::vector<Pose> priors;
  for (std::size_t i = 0; i < answers.size() && priors.size() < kCompeting; ++i) {
    if (i == 0 || answers[i].log_odds >= kWorthCorrecting) {
      answers[i].T_map_lidar = answers[i].T_map_lidar * correction;
      priors.push_back(answers[i].T_map_lidar);
    }
  }
  const std::vector<LocalizationHypothesis> again = state_->map->search(cloud, 0, priors);
  if (again.empty() || again.front().log_odds < 0.0) {
    return;
  }
  const double more = std::max(0.0, log_of_odds(answers) - log_of_odds(again));  // what farther submaps said
  for (std::size_t i = 0; i < priors.size(); ++i) {
    const auto same = std::find_if(again.begin(), again.end(), [&](const LocalizationHypothesis& answer) {
      return agree(answer.T_map_lidar, priors[i], state_->options);
    });
    answers[i].T_map_lidar = same == again.end() ? priors[i] : same->T_map_lidar;
    answers[i].log_odds = same == again.end() ? kNotThere : same->log_odds + more;
  }
  std::stable_sort(
      answers.begin(), answers.end(),
      [](const LocalizationHypothesis& a, const LocalizationHypothesis& b) { return a.log_odds > b.log_odds; });
}

/// Registers the scan to the places that look like it and to those believed so far, unless it hardly differs from the
/// one before.
void Relocalizer::search(const Scan& scan, odometry::TrackedScan tracked, RelocalizedScan& answer) {
  State& s = *state_;
  const Pose& T_odometry_lidar = tracked.T_map_lidar;
  if (s.is_due(s.searched_at, tracked, s.options.search_every_m)) {
    const PointCloud cloud = s.odometry.deskewed_cloud(scan, tracked.sweep_velocity);
    std::vector<LocalizationHypothesis> answers =
        s.searched ? *s.searched : s.map->search(cloud, s.options.places, s.priors(T_odometry_lidar));
    tracked.sweep_velocity = correct_first_scan(scan, tracked, answers);
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
    begin_tracking(best->T_map_odometry, T_odometry_lidar, std::log(best->p / std::max(1.0 - best->p, 1e-6)));
    s.verified_at = T_odometry_lidar;
    track(scan, tracked, true, answer);
  }
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

}  // namespace loopmark::localization

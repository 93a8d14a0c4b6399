// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/engine.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "align_to_ground.hpp"
#include "alignment.hpp"
#include "candidate_refiner.hpp"
#include "confidence.hpp"
#include "feature_hypotheses.hpp"
#include "loopmark/bev/correlation.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"

namespace loopmark::registration {
namespace {

constexpr std::size_t kRoughSurfels = 250;
constexpr double kResidualSigma = 0.05;  // metres; of one surfel, for the covariance
constexpr double kDependence = 40.0;     // surfels that say the same thing: neighbours do, and the two ways round

constexpr std::size_t kOwnFinalists = 3;
constexpr std::size_t kChance = 9;  // so many peaks higher, and a peak is chance's

/// Of a motion that did not come from the correlation: as one that stands out as right ones do.
constexpr internal::PeakHeights kNoCompetitor = {12.0, 4.0};

double score_of_chance(const auto& motions) {
  return motions.empty() ? 0.0 : motions[std::min(kChance, motions.size() - 1)].score;
}

/// A motion that many more matches agree with than chance's stands out as a peak of the correlation does that is as
/// many times as high as chance's.
internal::PeakHeights standing_out(double score, double chance) {
  const double times = chance > 0.0 ? score / chance : 1.0;
  return {times * kNoCompetitor.noise_floor, kNoCompetitor.noise_floor};
}

/// Planar motions between the levelled frames, by where they come from.
struct Guesses {
  std::vector<estimation::PlanarMotion> features;
  std::vector<bev::PlanarHypothesis> landmarks;
  std::vector<bev::PlanarHypothesis> bev;
};

Guesses guess(const PreparedScan::Data& source, const PreparedScan::Data& target, const EngineOptions& options) {
  Guesses guesses;
  parallel_for(3, [&](std::size_t task) {
    if (task == 0 && asks(options, kBev)) {
      guesses.bev = bev::correlate(source.above, target.above, options.correlation);
    } else if (task == 1 && asks(options, kFeatures)) {
      guesses.features = internal::match_features(*source.keypoints.of(source.fine), *target.keypoints.of(target.fine),
                                                  options.features);
    } else if (task == 2 && asks(options, kLandmarks)) {
      guesses.landmarks = bev::match_landmarks(source.landmarks, target.landmarks, options.landmarks);
    }
  });
  return guesses;
}

std::vector<internal::Candidate> hypothesize(const PreparedScan::Data& source, const PreparedScan::Data& target,
                                             const EngineOptions& options) {
  const Guesses guesses = guess(source, target, options);
  std::vector<internal::Candidate> candidates;
  const auto add = [&](double yaw, const Eigen::Vector3d& t, const char* origin, const internal::PeakHeights& peak) {
    internal::Candidate candidate;
    candidate.alignment.T_target_source = pose_from_yaw(yaw, t);
    candidate.origin = origin;
    candidate.peak = peak;
    candidates.push_back(candidate);
  };
  const double of_chance = score_of_chance(guesses.features);
  for (const estimation::PlanarMotion& m : guesses.features) {
    add(m.yaw, {m.t.x(), m.t.y(), 0.0}, kFeatures, standing_out(m.score, of_chance));
  }
  const double noise_floor = score_of_chance(guesses.bev);
  for (const bev::PlanarHypothesis& h : guesses.landmarks) {
    add(h.yaw, {h.x, h.y, 0.0}, kLandmarks, {0.0, noise_floor});
  }
  for (const bev::PlanarHypothesis& h : guesses.bev) {
    add(h.yaw, {h.x, h.y, 0.0}, kBev, {h.score, noise_floor});
  }
  return candidates;
}

/// Share of the structure surfels near a coarse surfel of the target that is no ground.
double rough_agreement(const std::vector<surfels::Surfel>& structure, const PreparedScan::Data& target,
                       const Pose& pose) {
  const Eigen::Isometry3f T = pose.cast<float>();
  double met = 0.0;
  for (const surfels::Surfel& surfel : structure) {
    const surfels::Surfel* other = target.coarse.nearest(T * surfel.mean, 0.8F);
    met += other != nullptr && other->height > kStructureHeight ? 1.0 : 0.0;
  }
  return met / std::max<double>(1.0, static_cast<double>(structure.size()));
}

/// Aligns every guess roughly and keeps the best by agreement and the best by correlation, half of each.
std::vector<internal::Candidate> shortlist(std::vector<internal::Candidate> candidates,
                                           const PreparedScan::Data& source, const PreparedScan::Data& target,
                                           const EngineOptions& options) {
  const std::vector<surfels::Surfel> some = internal::sampled(source.fine.surfels(), kRoughSurfels);
  const std::vector<surfels::Surfel> structure = internal::sampled_structure(source.fine.surfels(), kRoughSurfels);
  const std::vector<surfels::Surfel> ground = internal::sampled_ground(source.fine.surfels(), kRoughSurfels);
  std::vector<double> agreement(candidates.size());
  parallel_for(candidates.size(), [&](std::size_t i) {
    Pose& T = candidates[i].alignment.T_target_source;
    T = internal::align_surfels(some, target.coarse, internal::align_to_ground(T, ground, target.ground), 1.2F, 1.0, 6)
            .T_target_source;
    agreement[i] = rough_agreement(structure, target, T);
  });
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return agreement[a] > agreement[b]; });
  std::vector<bool> chosen(candidates.size(), false);
  std::vector<internal::Candidate> kept;
  const auto keep = [&](std::size_t i, std::size_t limit) {
    if (i < candidates.size() && !chosen[i] && kept.size() < limit) {
      chosen[i] = true;
      kept.push_back(candidates[i]);
    }
  };
  for (const std::size_t i : order) {
    keep(i, options.candidates / 2);
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    keep(i, options.candidates);
  }
  return kept;
}

/// The best of all, and the best of each other source's own: these have no peak of the correlation that speaks for
/// them.
std::vector<internal::Candidate> finalists(const std::vector<internal::Candidate>& candidates, std::size_t most) {
  std::vector<internal::Candidate> kept;
  std::map<std::string, std::size_t> own;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const std::string& origin = candidates[i].origin;
    if (i < most || (origin != kBev && own[origin] < kOwnFinalists)) {
      ++own[origin];
      kept.push_back(candidates[i]);
    }
  }
  return kept;
}

/// Covariance on the target sensor's side from the information between the levelled frames.
Matrix6d covariance_of(const internal::Alignment& alignment, const PreparedScan::Data& target) {
  const Matrix6d information = alignment.information / (kResidualSigma * kResidualSigma * kDependence);
  const Matrix6d damped = information + 1e-2 * Matrix6d::Identity();
  const Matrix6d to_sensor = adjoint(target.T_level_sensor.inverse());
  return to_sensor * damped.inverse() * to_sensor.transpose();
}

RegistrationMode to_mode(const internal::Candidate& candidate, double p, const PreparedScan::Data& source,
                         const PreparedScan::Data& target) {
  RegistrationMode mode;
  mode.T_target_source = target.T_level_sensor.inverse() * candidate.alignment.T_target_source * source.T_level_sensor;
  mode.p_correct = p;
  mode.origin = candidate.origin;
  for (std::size_t i = 0; i < internal::kFeatures; ++i) {
    mode.evidence.emplace_back(internal::kFeatureNames[i], candidate.features[i]);
  }
  mode.evidence.emplace_back("log_odds", candidate.log_odds);
  return mode;
}

/// Why a result below the asked probability is withheld, from the numbers of its best mode.
std::string reason_to_abstain(const std::vector<internal::Candidate>& candidates, const std::vector<double>& p) {
  if (candidates.empty()) {
    return "no structure above the ground to align";
  }
  if (candidates.size() > 1 && p[1] > 0.5 * p[0] && p[0] + p[1] > 0.5) {
    return "two places fit alike";
  }
  const internal::Features& f = candidates.front().features;
  if (internal::feature(f, "contradicted") > std::log1p(8.0) ||
      internal::feature(f, "tall_strong_violation") > std::log(0.05)) {
    return "beams of one scan pass through what the other saw";
  }
  return internal::feature(f, "agreement") < 0.25 ? "too little structure agrees" : "the evidence is weak";
}

RegistrationResult conclude(const std::vector<internal::Candidate>& candidates, const PreparedScan::Data& source,
                            const PreparedScan::Data& target, const EngineOptions& options) {
  std::vector<double> scores;
  for (const internal::Candidate& candidate : candidates) {
    scores.push_back(candidate.log_odds);
  }
  const std::vector<double> p = internal::probabilities(scores);
  RegistrationResult result;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    result.modes.push_back(to_mode(candidates[i], p[i], source, target));
  }
  if (!candidates.empty()) {
    result.T_target_source = result.modes.front().T_target_source;
    result.p_correct = p.front();
    result.covariance = covariance_of(candidates.front().alignment, target);
  }
  result.answered = !candidates.empty() && result.p_correct >= options.min_p_correct;
  if (!result.answered) {
    result.reason = reason_to_abstain(candidates, p);
  }
  return result;
}

/// Examines all candidates thoroughly, sharpens the best, and concludes over the distinct ones.
RegistrationResult decide(std::vector<internal::Candidate> candidates, const PreparedScan::Data& source,
                          const PreparedScan::Data& target, const EngineOptions& options,
                          std::vector<StageTime> timings) {
  Stopwatch watch;
  const internal::CandidateRefiner candidate_refiner(source, target, internal::kThorough);
  candidates = candidate_refiner.refine(std::move(candidates));
  candidates = candidate_refiner.refit_ground(std::move(candidates));
  candidates = candidate_refiner.perturb_pitch(std::move(candidates));
  candidates = candidate_refiner.align_inverse(std::move(candidates));
  timings.push_back({"refine and verify", watch.seconds()});
  watch.reset();
  if (!candidates.empty()) {
    internal::Candidate& best = candidates.front();
    best.alignment = internal::align_both_ways(source.fine, target.fine, best.alignment.T_target_source, 0.4F, 0.2, 6);
    candidate_refiner.judge(best);
  }
  RegistrationResult result = conclude(candidates, source, target, options);
  timings.push_back({"polish", watch.seconds()});
  result.timings = std::move(timings);
  return result;
}

}  // namespace

RegistrationResult register_scans(const PreparedScan& source, const PreparedScan& target,
                                  const EngineOptions& options) {
  check(options);
  Stopwatch watch;
  std::vector<internal::Candidate> candidates = hypothesize(source.data(), target.data(), options);
  std::vector<StageTime> timings = {{"hypotheses", watch.seconds()}};
  watch.reset();
  candidates = shortlist(std::move(candidates), source.data(), target.data(), options);
  candidates = internal::CandidateRefiner(source.data(), target.data(), internal::kQuick).refine(std::move(candidates));
  candidates = finalists(candidates, options.hypotheses);
  timings.push_back({"shortlist", watch.seconds()});
  return decide(std::move(candidates), source.data(), target.data(), options, std::move(timings));
}

RegistrationResult verify_motion(const PreparedScan& source, const PreparedScan& target, const Pose& T_target_source,
                                 const EngineOptions& options) {
  internal::Candidate guess;
  guess.origin = "guess";
  guess.peak = kNoCompetitor;
  guess.alignment.T_target_source =
      target.data().T_level_sensor * T_target_source * source.data().T_level_sensor.inverse();
  return decide({guess}, source.data(), target.data(), options, {});
}

}  // namespace loopmark::registration

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/engine.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "alignment.hpp"
#include "confidence.hpp"
#include "examiner.hpp"
#include "loopmark/birdseye/correlation.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "settling.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kRoughPatches = 250;
constexpr double kResidualSigma = 0.05;  // metres; of one patch, for the covariance
constexpr double kDependence = 40.0;     // patches that say the same thing: neighbours do, and the two ways round

constexpr const char* kLandmarks = "landmarks";
constexpr std::size_t kOwnFinalists = 3;
constexpr std::size_t kChance = 9;  // so many peaks higher, and a peak is chance's

/// Of a motion that did not come from the correlation: as one that stands out as right ones do.
constexpr PeakHeights kNoRival = {12.0, 4.0};

/// The guesses of landmarks and of the bird's-eye view: planar motions between the levelled frames.
std::vector<Candidate> hypothesize(const PreparedScan::Data& source, const PreparedScan::Data& target,
                                   const EngineOptions& options) {
  std::vector<Candidate> candidates;
  const auto add = [&](const birdseye::PlanarHypothesis& h, const char* origin, const PeakHeights& peak) {
    Candidate candidate;
    candidate.alignment.T_target_source = pose_from_yaw(h.yaw, {h.x, h.y, 0.0});
    candidate.origin = origin;
    candidate.peak = peak;
    candidates.push_back(candidate);
  };
  std::vector<birdseye::PlanarHypothesis> of_landmarks;
  std::vector<birdseye::PlanarHypothesis> planar;
  parallel_for(2, [&](std::size_t task) {
    if (task == 0) {
      of_landmarks = birdseye::match_landmarks(source.landmarks, target.landmarks, options.landmarks);
    } else {
      planar = birdseye::correlate(source.above, target.above, options.correlation);
    }
  });
  const double usual = planar.empty() ? 0.0 : planar[std::min(kChance, planar.size() - 1)].score;
  for (const auto& h : of_landmarks) {
    add(h, kLandmarks, {0.0, usual});
  }
  for (const auto& h : planar) {
    add(h, "birdseye", {h.score, usual});
  }
  return candidates;
}

/// Share of the structure patches near a coarse patch of the target that is no ground.
double rough_agreement(const std::vector<Patch>& structure, const PreparedScan::Data& target, const Pose& pose) {
  const Eigen::Isometry3f T = pose.cast<float>();
  double met = 0.0;
  for (const Patch& patch : structure) {
    const Patch* other = target.coarse.nearest(T * patch.mean, 0.8F);
    met += other != nullptr && other->height > kStructureHeight ? 1.0 : 0.0;
  }
  return met / std::max<double>(1.0, static_cast<double>(structure.size()));
}

/// Aligns every guess roughly and keeps the best by agreement and the best by correlation, half of each.
std::vector<Candidate> shortlist(std::vector<Candidate> candidates, const PreparedScan::Data& source,
                                 const PreparedScan::Data& target, const EngineOptions& options) {
  const std::vector<Patch> some = sampled(source.fine.patches(), kRoughPatches);
  const std::vector<Patch> structure = sampled_structure(source.fine.patches(), kRoughPatches);
  const std::vector<Patch> ground = sampled_ground(source.fine.patches(), kRoughPatches);
  std::vector<double> agreement(candidates.size());
  parallel_for(candidates.size(), [&](std::size_t i) {
    Pose& T = candidates[i].alignment.T_target_source;
    T = align_patches(some, target.coarse, settled(T, ground, target.ground), 1.2F, 1.0, 6).T_target_source;
    agreement[i] = rough_agreement(structure, target, T);
  });
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return agreement[a] > agreement[b]; });
  std::vector<bool> chosen(candidates.size(), false);
  std::vector<Candidate> kept;
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

/// The best of all, and the best of the landmarks' own: these have no peak that speaks for them.
std::vector<Candidate> finalists(const std::vector<Candidate>& candidates, std::size_t most) {
  std::vector<Candidate> kept;
  std::size_t own = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool of_landmarks = candidates[i].origin == kLandmarks;
    if (i < most || (of_landmarks && own < kOwnFinalists)) {
      own += of_landmarks ? 1 : 0;
      kept.push_back(candidates[i]);
    }
  }
  return kept;
}

/// Covariance on the target sensor's side from the information between the levelled frames.
Matrix6d covariance_of(const Alignment& alignment, const PreparedScan::Data& target) {
  const Matrix6d information = alignment.information / (kResidualSigma * kResidualSigma * kDependence);
  const Matrix6d damped = information + 1e-2 * Matrix6d::Identity();
  const Matrix6d to_sensor = adjoint(target.T_level_sensor.inverse());
  return to_sensor * damped.inverse() * to_sensor.transpose();
}

RegistrationMode to_mode(const Candidate& candidate, double p, const PreparedScan::Data& source,
                         const PreparedScan::Data& target) {
  RegistrationMode mode;
  mode.T_target_source = target.T_level_sensor.inverse() * candidate.alignment.T_target_source * source.T_level_sensor;
  mode.p_correct = p;
  mode.origin = candidate.origin;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    mode.evidence.emplace_back(kFeatureNames[i], candidate.features[i]);
  }
  mode.evidence.emplace_back("log_odds", candidate.log_odds);
  return mode;
}

/// Why a result below the asked probability is withheld, from the numbers of its best mode.
std::string reason_to_abstain(const std::vector<Candidate>& candidates, const std::vector<double>& p) {
  if (candidates.empty()) {
    return "no structure above the ground to align";
  }
  if (candidates.size() > 1 && p[1] > 0.5 * p[0] && p[0] + p[1] > 0.5) {
    return "two places fit alike";
  }
  const Features& f = candidates.front().features;
  if (feature(f, "contradicted") > std::log1p(8.0) || feature(f, "tall_clash") > std::log(0.05)) {
    return "beams of one scan pass through what the other saw";
  }
  return feature(f, "agreement") < 0.25 ? "too little structure agrees" : "the evidence is weak";
}

RegistrationResult conclude(const std::vector<Candidate>& candidates, const PreparedScan::Data& source,
                            const PreparedScan::Data& target, const EngineOptions& options) {
  std::vector<double> scores;
  for (const Candidate& candidate : candidates) {
    scores.push_back(candidate.log_odds);
  }
  const std::vector<double> p = probabilities(scores);
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
RegistrationResult decide(std::vector<Candidate> candidates, const PreparedScan::Data& source,
                          const PreparedScan::Data& target, const EngineOptions& options,
                          std::vector<StageTime> timings) {
  Stopwatch watch;
  const Examiner examiner(source, target, kThorough);
  candidates = examiner.examine(std::move(candidates));
  candidates = examiner.settled_anew(std::move(candidates));
  candidates = examiner.nodded(std::move(candidates));
  candidates = examiner.turned_about(std::move(candidates));
  timings.push_back({"refine and verify", watch.seconds()});
  watch.reset();
  if (!candidates.empty()) {
    Candidate& best = candidates.front();
    best.alignment = align_both_ways(source.fine, target.fine, best.alignment.T_target_source, 0.4F, 0.2, 6);
    examiner.judge(best);
  }
  RegistrationResult result = conclude(candidates, source, target, options);
  timings.push_back({"polish", watch.seconds()});
  result.timings = std::move(timings);
  return result;
}

}  // namespace

RegistrationResult register_scans(const PreparedScan& source, const PreparedScan& target,
                                  const EngineOptions& options) {
  Stopwatch watch;
  std::vector<Candidate> candidates = hypothesize(source.data(), target.data(), options);
  std::vector<StageTime> timings = {{"hypotheses", watch.seconds()}};
  watch.reset();
  candidates = shortlist(std::move(candidates), source.data(), target.data(), options);
  candidates = Examiner(source.data(), target.data(), kQuick).examine(std::move(candidates));
  candidates = finalists(candidates, options.hypotheses);
  timings.push_back({"shortlist", watch.seconds()});
  return decide(std::move(candidates), source.data(), target.data(), options, std::move(timings));
}

RegistrationResult verify_motion(const PreparedScan& source, const PreparedScan& target, const Pose& T_target_source,
                                 const EngineOptions& options) {
  Candidate guess;
  guess.origin = "guess";
  guess.peak = kNoRival;
  guess.alignment.T_target_source =
      target.data().T_level_sensor * T_target_source * source.data().T_level_sensor.inverse();
  return decide({guess}, source.data(), target.data(), options, {});
}

}  // namespace loopmark

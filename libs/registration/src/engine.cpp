// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/engine.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "alignment.hpp"
#include "confidence.hpp"
#include "evidence.hpp"
#include "loopmark/birdseye/correlation.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kRoughPatches = 250;
constexpr double kDistinctMetres = 1.0;
constexpr double kDistinctDegrees = 3.0;
constexpr double kResidualSigma = 0.05;  // metres; of one patch, for the covariance
constexpr double kDependence = 20.0;     // patches that say the same thing: neighbours are not independent

/// A motion between the levelled frames and what it rests on.
struct Candidate {
  Alignment alignment;
  std::string origin;
  double peak = 0.0;
  Features features{};
  double log_odds = 0.0;
};

/// The bird's-eye view's guesses: planar motions between the levelled frames.
std::vector<Candidate> hypothesize(const PreparedScan::Data& source, const PreparedScan::Data& target,
                                   const EngineOptions& options) {
  std::vector<Candidate> candidates;
  const auto planar = birdseye::correlate(source.cells, target.cells, options.correlation);
  for (const birdseye::PlanarHypothesis& h : planar) {
    Candidate candidate;
    candidate.alignment.T_target_source = pose_from_yaw(h.yaw, {h.x, h.y, 0.0});
    candidate.origin = "birdseye";
    candidate.peak = h.score;
    candidates.push_back(candidate);
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
  std::vector<double> agreement(candidates.size());
  parallel_for(candidates.size(), [&](std::size_t i) {
    Pose& T = candidates[i].alignment.T_target_source;
    T = align_patches(some, target.coarse, T, 1.2F, 1.0, 6).T_target_source;
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
    keep(i, options.hypotheses / 2);
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    keep(i, options.hypotheses);
  }
  return kept;
}

/// Coarse, then fine alignment on patches.
void refine(Candidate& candidate, const std::vector<Patch>& coarse, const std::vector<Patch>& fine,
            const PreparedScan::Data& target) {
  Pose& T = candidate.alignment.T_target_source;
  T = align_patches(coarse, target.coarse, T, 1.2F, 1.0, 10).T_target_source;
  candidate.alignment = align_patches(fine, target.fine, T, 0.4F, 0.3, 8);
}

void judge(Candidate& candidate, const PreparedScan::Data& source, const PreparedScan::Data& target) {
  candidate.features = features_of(source, target, candidate.alignment, candidate.peak);
  candidate.log_odds = log_odds(candidate.features);
}

/// The candidates that differ, the most probable first.
std::vector<Candidate> distinct(std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.log_odds > b.log_odds; });
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      const PoseError error = pose_error(candidate.alignment.T_target_source, k.alignment.T_target_source);
      return error.translation_m < kDistinctMetres && error.rotation_deg < kDistinctDegrees;
    });
    if (!known) {
      kept.push_back(std::move(candidate));
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
  if (f[2] > std::log(0.2) || f[4] > std::log(0.05)) {
    return "beams of one scan pass through what the other saw";
  }
  return f[0] < 0.25 ? "too little structure agrees" : "the evidence is weak";
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

/// Refines and judges all candidates, then concludes over the distinct ones.
RegistrationResult decide(std::vector<Candidate> candidates, const PreparedScan::Data& source,
                          const PreparedScan::Data& target, const EngineOptions& options,
                          std::vector<StageTime> timings) {
  Stopwatch watch;
  const std::vector<Patch> coarse = sampled(source.fine.patches(), 800);
  const std::vector<Patch> fine = sampled(source.fine.patches(), 1500);
  parallel_for(candidates.size(), [&](std::size_t i) {
    refine(candidates[i], coarse, fine, target);
    judge(candidates[i], source, target);
  });
  timings.push_back({"refine and verify", watch.seconds()});
  watch.reset();
  candidates = distinct(std::move(candidates));
  if (!candidates.empty()) {
    Candidate& best = candidates.front();
    best.alignment = align_patches(source.fine.patches(), target.fine, best.alignment.T_target_source, 0.4F, 0.2, 6);
    judge(best, source, target);
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
  timings.push_back({"shortlist", watch.seconds()});
  return decide(std::move(candidates), source.data(), target.data(), options, std::move(timings));
}

RegistrationResult verify_motion(const PreparedScan& source, const PreparedScan& target, const Pose& T_target_source,
                                 const EngineOptions& options) {
  Candidate guess;
  guess.origin = "guess";
  guess.alignment.T_target_source =
      target.data().T_level_sensor * T_target_source * source.data().T_level_sensor.inverse();
  return decide({guess}, source.data(), target.data(), options, {});
}

}  // namespace loopmark

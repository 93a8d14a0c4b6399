// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "candidate_refiner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "align_to_ground.hpp"
#include "alignment.hpp"
#include "confidence.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::registration::internal {
namespace {

constexpr std::size_t kGroundSurfels = 250;
constexpr double kNodsFrom = 10.0;                                       // metres
constexpr std::array<double, 4> kNods = {-0.042, -0.021, 0.021, 0.042};  // radians
constexpr double kDistinctMetres = 1.0;
constexpr double kDistinctDegrees = 3.0;

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

Pose planar(const Pose& T) {
  const double yaw = std::atan2(T.linear()(1, 0), T.linear()(0, 0));
  return pose_from_yaw(yaw, {T.translation().x(), T.translation().y(), 0.0});
}

}  // namespace

CandidateRefiner::CandidateRefiner(const PreparedScan::Data& source, const PreparedScan::Data& target,
                                   const Effort& effort)
    : source_(source),
      target_(target),
      effort_(effort),
      coarse_(sampled(source.fine.surfels(), effort.coarse_surfels)),
      fine_(sampled(source.fine.surfels(), effort.fine_surfels)),
      ground_(sampled_ground(source.fine.surfels(), kGroundSurfels)),
      verifier_(source, target, effort.samples) {}

std::vector<Candidate> CandidateRefiner::refine(std::vector<Candidate> candidates) const {
  parallel_for(candidates.size(),
               [&](std::size_t i) { candidates[i] = refined(candidates[i], effort_.coarse_rounds); });
  return distinct(std::move(candidates));
}

std::vector<Candidate> CandidateRefiner::refit_ground(std::vector<Candidate> candidates) const {
  std::vector<Candidate> anew = candidates;
  parallel_for(anew.size(), [&](std::size_t i) {
    Pose& T = anew[i].alignment.T_target_source;
    T = align_to_ground(planar(T), ground_, target_.ground);
    anew[i] = refined(anew[i], 0);
  });
  candidates.insert(candidates.end(), anew.begin(), anew.end());
  return distinct(std::move(candidates));
}

std::vector<Candidate> CandidateRefiner::perturb_pitch(std::vector<Candidate> candidates) const {
  if (candidates.empty() || candidates.front().alignment.T_target_source.translation().norm() < kNodsFrom) {
    return candidates;
  }
  const Pose T = candidates.front().alignment.T_target_source;
  const Eigen::Vector3d middle = 0.5 * T.translation();
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(T.translation()).normalized();
  std::vector<Candidate> anew(kNods.size(), candidates.front());
  parallel_for(anew.size(), [&](std::size_t i) {
    const Eigen::AngleAxisd nod(kNods[i], across);
    anew[i].alignment.T_target_source = Eigen::Translation3d(middle) * nod * Eigen::Translation3d(-middle) * T;
    anew[i] = refined(anew[i], 0);
  });
  candidates.insert(candidates.end(), anew.begin(), anew.end());
  return distinct(std::move(candidates));
}

std::vector<Candidate> CandidateRefiner::align_inverse(std::vector<Candidate> candidates) const {
  if (candidates.empty() || candidates.front().alignment.T_target_source.translation().norm() < kNodsFrom) {
    return candidates;
  }
  Candidate anew = candidates.front();
  Pose& T = anew.alignment.T_target_source;
  const std::vector<surfels::Surfel> ground = sampled_ground(target_.fine.surfels(), kGroundSurfels);
  const std::vector<surfels::Surfel> fine = sampled(target_.fine.surfels(), effort_.fine_surfels);
  const Pose T_source_target = align_to_ground(planar(T).inverse(), ground, source_.ground);
  anew.alignment = align_surfels(fine, source_.fine, T_source_target, 0.4F, 0.3, effort_.fine_rounds);
  T = T.inverse();
  judge(anew);
  candidates.push_back(anew);
  return distinct(std::move(candidates));
}

void CandidateRefiner::judge(Candidate& candidate) const {
  candidate.features = verifier_.features(candidate.alignment, candidate.peak);
  candidate.log_odds = log_odds(candidate.features);
}

Candidate CandidateRefiner::refined(Candidate c, int coarse_rounds) const {
  const Pose& start = c.alignment.T_target_source;
  const Pose T = align_surfels(coarse_, target_.coarse, start, 1.2F, 1.0, coarse_rounds).T_target_source;
  c.alignment = align_surfels(fine_, target_.fine, T, 0.4F, 0.3, effort_.fine_rounds);
  judge(c);
  return c;
}

}  // namespace loopmark::registration::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "examiner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alignment.hpp"
#include "confidence.hpp"
#include "loopmark/core/parallel.hpp"
#include "settling.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kGroundPatches = 250;
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

Examiner::Examiner(const PreparedScan::Data& source, const PreparedScan::Data& target, const Effort& effort)
    : source_(source),
      target_(target),
      effort_(effort),
      coarse_(sampled(source.fine.patches(), effort.coarse_patches)),
      fine_(sampled(source.fine.patches(), effort.fine_patches)),
      ground_(sampled_ground(source.fine.patches(), kGroundPatches)),
      inquiry_(source, target, effort.asked) {}

std::vector<Candidate> Examiner::examine(std::vector<Candidate> candidates) const {
  parallel_for(candidates.size(),
               [&](std::size_t i) { candidates[i] = examined(candidates[i], effort_.coarse_rounds); });
  return distinct(std::move(candidates));
}

std::vector<Candidate> Examiner::settled_anew(std::vector<Candidate> candidates) const {
  std::vector<Candidate> anew = candidates;
  parallel_for(anew.size(), [&](std::size_t i) {
    Pose& T = anew[i].alignment.T_target_source;
    T = settled(planar(T), ground_, target_.ground);
    anew[i] = examined(anew[i], 0);
  });
  candidates.insert(candidates.end(), anew.begin(), anew.end());
  return distinct(std::move(candidates));
}

std::vector<Candidate> Examiner::nodded(std::vector<Candidate> candidates) const {
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
    anew[i] = examined(anew[i], 0);
  });
  candidates.insert(candidates.end(), anew.begin(), anew.end());
  return distinct(std::move(candidates));
}

std::vector<Candidate> Examiner::turned_about(std::vector<Candidate> candidates) const {
  if (candidates.empty() || candidates.front().alignment.T_target_source.translation().norm() < kNodsFrom) {
    return candidates;
  }
  Candidate anew = candidates.front();
  Pose& T = anew.alignment.T_target_source;
  const std::vector<Patch> ground = sampled_ground(target_.fine.patches(), kGroundPatches);
  const std::vector<Patch> fine = sampled(target_.fine.patches(), effort_.fine_patches);
  const Pose T_source_target = settled(planar(T).inverse(), ground, source_.ground);
  anew.alignment = align_patches(fine, source_.fine, T_source_target, 0.4F, 0.3, effort_.fine_rounds);
  T = T.inverse();
  judge(anew);
  candidates.push_back(anew);
  return distinct(std::move(candidates));
}

void Examiner::judge(Candidate& candidate) const {
  candidate.features = inquiry_.features(candidate.alignment, candidate.peak);
  candidate.log_odds = log_odds(candidate.features);
}

Candidate Examiner::examined(Candidate c, int coarse_rounds) const {
  const Pose& start = c.alignment.T_target_source;
  const Pose T = align_patches(coarse_, target_.coarse, start, 1.2F, 1.0, coarse_rounds).T_target_source;
  c.alignment = align_patches(fine_, target_.fine, T, 0.4F, 0.3, effort_.fine_rounds);
  judge(c);
  return c;
}

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_registration.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "loopmark/core/parallel.hpp"

namespace loopmark::localization::internal {
namespace {

constexpr double kLeastLogOdds = -5.0;  ///< modes below it say nothing
constexpr double kSure = 5.0;           ///< log-odds of an answer that no further submap is asked about
constexpr double kMostGain = 3.0;       ///< log-odds that the nearest submap may add to those of a farther one

/// Registration to submaps takes coarser and fewer steps than the engine's own: an answer that is worth more is refined
/// and judged as thoroughly either way.
registration::EngineOptions coarser(registration::EngineOptions engine) {
  engine.correlation.side = std::min<std::size_t>(engine.correlation.side, 128);
  engine.correlation.cell_m = std::max(engine.correlation.cell_m, 1.2);
  engine.correlation.yaw_step_deg = std::max(engine.correlation.yaw_step_deg, 5.0);
  engine.correlation.peaks = std::min<std::size_t>(engine.correlation.peaks, 40);
  engine.candidates = std::min<std::size_t>(engine.candidates, 24);
  engine.hypotheses = std::min<std::size_t>(engine.hypotheses, 4);
  return engine;
}

SubmapHypotheses joined(std::vector<SubmapHypotheses> parts) {
  SubmapHypotheses all;
  for (SubmapHypotheses& part : parts) {
    append(all, std::move(part));
  }
  return all;
}

}  // namespace

void append(SubmapHypotheses& all, SubmapHypotheses more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

PlaceRegistration::PlaceRegistration(const PlaceSubmaps& submaps, const RelocalizationOptions& options,
                                     const registration::EngineOptions& engine)
    : submaps_(submaps), options_(options), engine_(coarser(engine)) {}

registration::PreparedScan PlaceRegistration::prepared(const PointCloud& scan) const {
  return registration::prepare_scan(scan, engine_);
}

SubmapHypotheses PlaceRegistration::modes(const registration::RegistrationResult& result, std::size_t center) const {
  const Pose& T_map_center = submaps_.T_map_keyframe(center);
  const Matrix6d to_map = adjoint(T_map_center);
  const std::vector<double> log_odds = log_odds_of_modes(result);
  SubmapHypotheses found;
  for (std::size_t i = 0; i < log_odds.size(); ++i) {
    if (log_odds[i] >= kLeastLogOdds) {
      SubmapHypothesis one;
      one.answer.T_map_lidar = T_map_center * result.modes[i].T_target_source;
      one.answer.covariance = to_map * result.covariance * to_map.transpose();
      one.answer.evidence = result.modes[i].evidence;
      one.place_evidence.registration = log_odds[i];
      one.center = center;
      one.own_covariance = i == 0;
      one.centers = {center};
      found.push_back(std::move(one));
    }
  }
  return found;
}

SubmapHypotheses PlaceRegistration::to_submaps(const registration::PreparedScan& scan,
                                               const std::vector<std::size_t>& centers) const {
  std::vector<SubmapHypotheses> each(centers.size());
  parallel_for(centers.size(), [&](std::size_t i) {
    each[i] = modes(registration::register_scans(scan, submaps_.prepared(centers[i]), engine_), centers[i]);
  });
  return joined(std::move(each));
}

/// A pose, as the submap around a center says.
SubmapHypotheses PlaceRegistration::verify_at(const registration::PreparedScan& scan, std::size_t center,
                                              const Pose& T_map_lidar) const {
  const Pose T_center_source = submaps_.T_map_keyframe(center).inverse() * T_map_lidar;
  return modes(registration::verify_motion(scan, submaps_.prepared(center), T_center_source, engine_), center);
}

/// The poses that are believed, judged as those that were searched are.
SubmapHypotheses PlaceRegistration::at_poses(const registration::PreparedScan& scan,
                                             const std::vector<Pose>& priors) const {
  std::vector<SubmapHypotheses> each(priors.size());
  parallel_for(priors.size(), [&](std::size_t i) {
    for (const std::size_t center : submaps_.judges_of(priors[i].translation())) {
      append(each[i], verify_at(scan, center, priors[i]));
    }
  });
  return joined(std::move(each));
}

/// Where no submap stands off, the one around the pose speaks for it.
std::optional<double> PlaceRegistration::verdict(const registration::PreparedScan& scan,
                                                 const Pose& T_map_lidar) const {
  const std::vector<std::size_t> judges = submaps_.judges_of(T_map_lidar.translation());
  if (judges.empty() || submaps_.distance(judges.front(), T_map_lidar.translation()) > options_.place_radius_m) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (const std::size_t center : judges) {
    double best = kNotThere;
    for (const SubmapHypothesis& one : verify_at(scan, center, T_map_lidar)) {
      const bool same = agree(one.answer.T_map_lidar, T_map_lidar, options_);
      best = same ? std::max(best, one.place_evidence.registration) : best;
    }
    sum += best;
  }
  return judges.size() == 1 ? 2.0 * sum : sum;
}

/// With each answer, what those submaps say of it that see most of what the scan sees: the one by which it was found
/// may be a hundred metres away.
SubmapHypotheses PlaceRegistration::judged_nearby(const registration::PreparedScan& scan,
                                                  SubmapHypotheses found) const {
  SubmapHypotheses distinct = distinct_hypotheses(std::move(found), options_);
  std::vector<SubmapHypotheses> each(distinct.size());
  parallel_for(distinct.size(), [&](std::size_t i) {
    const SubmapHypothesis& one = distinct[i];
    for (const std::size_t center : submaps_.judges_of(one.answer.T_map_lidar.translation())) {
      if (one.place_evidence.registration >= kSure || (one.own_covariance && one.centers.count(center) > 0)) {
        continue;
      }
      for (SubmapHypothesis& near : verify_at(scan, center, one.answer.T_map_lidar)) {
        near.place_evidence.registration =
            std::min(near.place_evidence.registration, one.place_evidence.registration + kMostGain);
        each[i].push_back(std::move(near));
      }
    }
  });
  append(distinct, joined(std::move(each)));
  return distinct;
}

}  // namespace loopmark::localization::internal

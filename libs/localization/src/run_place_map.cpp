// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/localization/run_place_map.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "competing_hypotheses.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/places/place_index.hpp"
#include "place_confidence.hpp"
#include "place_registration.hpp"

namespace loopmark::localization {
namespace {

constexpr std::size_t kMatchesPerPlace = 24;           ///< keyframes asked of the index for each place wanted
constexpr std::array<std::size_t, 2> kFirst = {2, 2};  ///< places that are asked at a time, before all others
constexpr double kKeyframeVoxel = 0.2;                 ///< metres; as keyframes are kept by default
constexpr double kSuspectLogOdds = -1.5;               ///< from here on the twins of a place are asked too
constexpr double kSettled = 3.0;  ///< log-odds of an answer behind which no further places are asked

/// A scan that is searched.
struct Query {
  registration::PreparedScan scan;
  std::optional<places::PlaceDescriptor> descriptor;  ///< nothing: the places are told
  double least_distance = 0.0;                        ///< of the descriptor to those of the map
};

class RunPlaceMap final : public PlaceMap {
 public:
  RunPlaceMap(const map_store::RunFolder& run, const mapping::SolvedMap& solved, const RelocalizationOptions& options,
              const registration::EngineOptions& engine, const std::set<std::size_t>& left_out)
      : run_(run),
        options_(options),
        submaps_(run, solved, left_out, options.place_radius_m, engine),
        registration_(submaps_, options, engine) {
    std::vector<places::PlaceDescriptor> descriptors(submaps_.size());
    parallel_for(descriptors.size(),
                 [&](std::size_t k) { descriptors[k] = map_store::read_keyframe_place(run_, submaps_.number(k)); });
    for (std::size_t k = 0; k < descriptors.size(); ++k) {
      index_.add(k, descriptors[k]);
    }
  }

  std::vector<LocalizationHypothesis> search(const PointCloud& scan, std::size_t places,
                                             const std::vector<Pose>& priors) const override;

  std::vector<LocalizationHypothesis> judge(const PointCloud& scan, const std::vector<Pose>& priors) const override {
    std::vector<LocalizationHypothesis> answers;
    internal::SubmapHypotheses found = registration_.at_poses(registration_.prepared(scan), priors);
    for (internal::SubmapHypothesis& one : internal::distinct_hypotheses(std::move(found), options_)) {
      one.answer.log_odds = one.place_evidence.registration;
      answers.push_back(std::move(one.answer));
    }
    return answers;
  }

  std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& position, double radius) const override;

 private:
  std::vector<std::size_t> distinct_places(const std::vector<places::PlaceMatch>& matches, std::size_t places,
                                           std::vector<std::size_t> known) const;
  std::vector<std::size_t> aliased_places(const internal::SubmapHypotheses& found,
                                          const std::vector<std::size_t>& asked) const;
  bool settled(const internal::SubmapHypotheses& found) const;
  double descriptor_lag(const Query& query, const Eigen::Vector3d& position) const;
  std::vector<LocalizationHypothesis> ranked(internal::SubmapHypotheses found, const Query& query) const;
  std::vector<std::optional<double>> verdicts(const std::vector<LocalizationHypothesis>& answers,
                                              const registration::PreparedScan& scan) const;

  map_store::RunFolder run_;
  RelocalizationOptions options_;
  internal::PlaceSubmaps submaps_;
  internal::PlaceRegistration registration_;
  places::PlaceIndex index_;
};

/// Asks a few places at a time, the most alike first, until one is sure and its twins have been asked.
std::vector<LocalizationHypothesis> RunPlaceMap::search(const PointCloud& scan, std::size_t places,
                                                        const std::vector<Pose>& priors) const {
  Query query{registration_.prepared(scan), {}, 0.0};
  internal::SubmapHypotheses found = registration_.at_poses(query.scan, priors);
  if (places == 0) {
    return ranked(std::move(found), query);
  }
  query.descriptor = map_store::place_of(cloud::voxel_downsampled(scan, kKeyframeVoxel));
  const std::vector<places::PlaceMatch> alike = index_.query(*query.descriptor, kMatchesPerPlace * places);
  query.least_distance = alike.empty() ? 0.0 : alike.front().distance;
  const std::vector<std::size_t> order = distinct_places(alike, places, {});
  std::vector<std::size_t> asked;
  const auto ask = [&](const std::vector<std::size_t>& centers) {
    asked.insert(asked.end(), centers.begin(), centers.end());
    append(found, registration_.judged_nearby(query.scan, registration_.to_submaps(query.scan, centers)));
  };
  bool sure = false;
  for (std::size_t done = 0, wave = 0; done < order.size() && !sure; ++wave) {
    const std::size_t some = wave < kFirst.size() ? kFirst[wave] : order.size();
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(done);
    done = std::min(order.size(), done + some);
    ask({begin, order.begin() + static_cast<std::ptrdiff_t>(done)});
    if (settled(found)) {
      ask(aliased_places(found, asked));
      sure = settled(found);
    }
  }
  if (!sure) {
    ask(aliased_places(found, asked));
  }
  return ranked(std::move(found), query);
}

std::vector<Eigen::Vector3d> RunPlaceMap::points_around(const Eigen::Vector3d& position, double radius) const {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t k : submaps_.within(position, 0.7 * radius)) {
    for (const Eigen::Vector3f& p : map_store::read_keyframe_cloud(run_, submaps_.number(k)).points) {
      const Eigen::Vector3d q = submaps_.T_map_keyframe(k) * p.cast<double>();
      if ((q - position).norm() < radius) {
        points.push_back(q);
      }
    }
  }
  return points;
}

/// The centers of the first `matches`, none near another nor near one that is `known`.
std::vector<std::size_t> RunPlaceMap::distinct_places(const std::vector<places::PlaceMatch>& matches,
                                                      std::size_t places, std::vector<std::size_t> known) const {
  std::vector<std::size_t> chosen;
  for (const places::PlaceMatch& match : matches) {
    const std::size_t center = submaps_.center_of(match.id);
    const bool there = std::any_of(known.begin(), known.end(), [&](std::size_t other) {
      return submaps_.distance(other, submaps_.T_map_keyframe(center).translation()) < options_.places_apart_m;
    });
    if (!there && chosen.size() < places) {
      known.push_back(center);
      chosen.push_back(center);
    }
  }
  return chosen;
}

/// Places that look like the one where the scan was found and were not asked: one of them may be where it is.
std::vector<std::size_t> RunPlaceMap::aliased_places(const internal::SubmapHypotheses& found,
                                                     const std::vector<std::size_t>& asked) const {
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const internal::SubmapHypothesis& a, const internal::SubmapHypothesis& b) {
                                       return a.place_evidence.registration < b.place_evidence.registration;
                                     });
  if (best == found.end() || best->place_evidence.registration < kSuspectLogOdds) {
    return {};
  }
  const Eigen::Vector3d here = submaps_.T_map_keyframe(best->center).translation();
  const auto elsewhere = [&](std::size_t k) { return submaps_.distance(k, here) > options_.places_apart_m; };
  const places::PlaceDescriptor descriptor = map_store::read_keyframe_place(run_, submaps_.number(best->center));
  return distinct_places(index_.query(descriptor, kMatchesPerPlace * options_.aliased_places, elsewhere),
                         options_.aliased_places, asked);
}

/// Whether one answer is sure and no other place, 5 m or 20 degrees away, fits too.
bool RunPlaceMap::settled(const internal::SubmapHypotheses& found) const {
  const internal::SubmapHypotheses distinct = internal::distinct_hypotheses(found, options_);
  return !distinct.empty() && distinct.front().place_evidence.registration >= kSettled &&
         std::all_of(distinct.begin() + 1, distinct.end(), [&](const internal::SubmapHypothesis& other) {
           return other.place_evidence.registration < 0.0 ||
                  !are_different_places(other.answer.T_map_lidar, distinct.front().answer.T_map_lidar);
         });
}

/// How much less the map around a position looks like the scan than what looks most like it.
double RunPlaceMap::descriptor_lag(const Query& query, const Eigen::Vector3d& position) const {
  if (!query.descriptor) {
    return 0.0;
  }
  const auto here = [&](std::size_t k) { return submaps_.distance(k, position) < options_.place_radius_m; };
  const std::vector<places::PlaceMatch> nearest = index_.query_exactly(*query.descriptor, 1, here);
  return nearest.empty() ? internal::kMostLag : nearest.front().distance - query.least_distance;
}

/// Each distinct answer once, the most probable first, with its log-odds among all places.
std::vector<LocalizationHypothesis> RunPlaceMap::ranked(internal::SubmapHypotheses found, const Query& query) const {
  std::vector<LocalizationHypothesis> answers;
  internal::SubmapHypotheses distinct = internal::distinct_hypotheses(std::move(found), options_);
  for (internal::SubmapHypothesis& one : distinct) {
    one.place_evidence.descriptor_lag = descriptor_lag(query, one.answer.T_map_lidar.translation());
    one.place_evidence.beyond_best = internal::compared(one.answer.evidence, distinct.front().answer.evidence);
  }
  for (internal::SubmapHypothesis& one : distinct) {
    one.answer.log_odds = internal::place_log_odds(one.place_evidence);
    const registration::Evidence place_evidence = internal::evidence_of(one.place_evidence);
    one.answer.evidence.insert(one.answer.evidence.begin(), place_evidence.begin(), place_evidence.end());
    answers.push_back(std::move(one.answer));
  }
  internal::separate_competing_hypotheses(answers, verdicts(answers, query.scan));
  std::stable_sort(
      answers.begin(), answers.end(),
      [](const LocalizationHypothesis& a, const LocalizationHypothesis& b) { return a.log_odds > b.log_odds; });
  return answers;
}

/// What submaps that stand alike say of each competitor; of one alone nothing is asked.
std::vector<std::optional<double>> RunPlaceMap::verdicts(const std::vector<LocalizationHypothesis>& answers,
                                                         const registration::PreparedScan& scan) const {
  const std::vector<std::size_t> competitors = internal::competing_among(answers);
  std::vector<std::optional<double>> verdicts(answers.size());
  if (competitors.size() > 1) {
    parallel_for(competitors.size(), [&](std::size_t i) {
      verdicts[competitors[i]] = registration_.verdict(scan, answers[competitors[i]].T_map_lidar);
    });
  }
  return verdicts;
}

}  // namespace

std::shared_ptr<const PlaceMap> open_place_map(const map_store::RunFolder& run, const mapping::SolvedMap& solved,
                                               const RelocalizationOptions& options,
                                               const registration::EngineOptions& engine,
                                               const std::vector<std::size_t>& left_out) {
  check(options);
  return std::make_shared<RunPlaceMap>(run, solved, options, engine,
                                       std::set<std::size_t>(left_out.begin(), left_out.end()));
}

}  // namespace loopmark::localization

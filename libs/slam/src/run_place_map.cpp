// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/run_place_map.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/places/place_index.hpp"
#include "place_confidence.hpp"
#include "place_registration.hpp"
#include "place_rivals.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kMatchesPerPlace = 24;           ///< keyframes asked of the index for each place wanted
constexpr std::array<std::size_t, 2> kFirst = {2, 2};  ///< places that are asked at a time, before all others
constexpr double kKeyframeVoxel = 0.2;                 ///< metres; as keyframes are kept by default
constexpr double kSuspectLogOdds = -1.5;               ///< from here on the twins of a place are asked too
constexpr double kSettled = 3.0;  ///< log-odds of an answer behind which no further places are asked

/// A scan that is searched.
struct Query {
  PreparedScan scan;
  std::optional<PlaceSignature> signature;  ///< nothing: the places are told
  double least_distance = 0.0;              ///< of the signature to those of the map
};

class RunPlaceMap final : public PlaceMap {
 public:
  RunPlaceMap(const RunFolder& run, const SolvedMap& solved, const RelocalizationOptions& options,
              const EngineOptions& engine, const std::set<std::size_t>& left_out)
      : run_(run),
        options_(options),
        submaps_(run, solved, left_out, options.place_radius_m, engine),
        registration_(submaps_, options, engine) {
    std::vector<PlaceSignature> signatures(submaps_.size());
    parallel_for(signatures.size(),
                 [&](std::size_t k) { signatures[k] = read_keyframe_place(run_, submaps_.number(k)); });
    for (std::size_t k = 0; k < signatures.size(); ++k) {
      index_.add(k, signatures[k]);
    }
  }

  std::vector<PlaceAnswer> search(const PointCloud& scan, std::size_t places,
                                  const std::vector<Pose>& believed) const override;

  std::vector<PlaceAnswer> judge(const PointCloud& scan, const std::vector<Pose>& believed) const override {
    std::vector<PlaceAnswer> answers;
    Found found = registration_.at_poses(registration_.prepared(scan), believed);
    for (FoundPlace& one : distinct_places_found(std::move(found), options_)) {
      one.answer.log_odds = one.voices.registration;
      answers.push_back(std::move(one.answer));
    }
    return answers;
  }

  std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& position, double radius) const override;

 private:
  std::vector<std::size_t> distinct_places(const std::vector<PlaceMatch>& matches, std::size_t places,
                                           std::vector<std::size_t> known) const;
  std::vector<std::size_t> twins(const Found& found, const std::vector<std::size_t>& asked) const;
  bool settled(const Found& found) const;
  double signature_lag(const Query& query, const Eigen::Vector3d& position) const;
  std::vector<PlaceAnswer> concluded(Found found, const Query& query) const;
  std::vector<std::optional<double>> verdicts(const std::vector<PlaceAnswer>& answers, const PreparedScan& scan) const;

  RunFolder run_;
  RelocalizationOptions options_;
  PlaceSubmaps submaps_;
  PlaceRegistration registration_;
  PlaceIndex index_;
};

/// Asks a few places at a time, the most alike first, until one is sure and its twins have been asked.
std::vector<PlaceAnswer> RunPlaceMap::search(const PointCloud& scan, std::size_t places,
                                             const std::vector<Pose>& believed) const {
  Query query{registration_.prepared(scan), {}, 0.0};
  Found found = registration_.at_poses(query.scan, believed);
  if (places == 0) {
    return concluded(std::move(found), query);
  }
  query.signature = place_of(voxel_downsampled(scan, kKeyframeVoxel));
  const std::vector<PlaceMatch> alike = index_.query(*query.signature, kMatchesPerPlace * places);
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
      ask(twins(found, asked));
      sure = settled(found);
    }
  }
  if (!sure) {
    ask(twins(found, asked));
  }
  return concluded(std::move(found), query);
}

std::vector<Eigen::Vector3d> RunPlaceMap::points_around(const Eigen::Vector3d& position, double radius) const {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t k : submaps_.within(position, 0.7 * radius)) {
    for (const Eigen::Vector3f& p : read_keyframe_cloud(run_, submaps_.number(k)).points) {
      const Eigen::Vector3d q = submaps_.T_map_keyframe(k) * p.cast<double>();
      if ((q - position).norm() < radius) {
        points.push_back(q);
      }
    }
  }
  return points;
}

/// The centers of the first `matches`, none near another nor near one that is `known`.
std::vector<std::size_t> RunPlaceMap::distinct_places(const std::vector<PlaceMatch>& matches, std::size_t places,
                                                      std::vector<std::size_t> known) const {
  std::vector<std::size_t> chosen;
  for (const PlaceMatch& match : matches) {
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
std::vector<std::size_t> RunPlaceMap::twins(const Found& found, const std::vector<std::size_t>& asked) const {
  const auto best = std::max_element(found.begin(), found.end(), [](const FoundPlace& a, const FoundPlace& b) {
    return a.voices.registration < b.voices.registration;
  });
  if (best == found.end() || best->voices.registration < kSuspectLogOdds) {
    return {};
  }
  const Eigen::Vector3d here = submaps_.T_map_keyframe(best->center).translation();
  const auto elsewhere = [&](std::size_t k) { return submaps_.distance(k, here) > options_.places_apart_m; };
  const PlaceSignature signature = read_keyframe_place(run_, submaps_.number(best->center));
  return distinct_places(index_.query(signature, kMatchesPerPlace * options_.twins, elsewhere), options_.twins, asked);
}

/// Whether one answer is sure and no other place, 5 m or 20 degrees away, fits too.
bool RunPlaceMap::settled(const Found& found) const {
  const Found distinct = distinct_places_found(found, options_);
  return !distinct.empty() && distinct.front().voices.registration >= kSettled &&
         std::all_of(distinct.begin() + 1, distinct.end(), [&](const FoundPlace& other) {
           return other.voices.registration < 0.0 ||
                  !are_elsewhere(other.answer.T_map_lidar, distinct.front().answer.T_map_lidar);
         });
}

/// How much less the map around a position looks like the scan than what looks most like it.
double RunPlaceMap::signature_lag(const Query& query, const Eigen::Vector3d& position) const {
  if (!query.signature) {
    return 0.0;
  }
  const auto here = [&](std::size_t k) { return submaps_.distance(k, position) < options_.place_radius_m; };
  const std::vector<PlaceMatch> nearest = index_.query_exactly(*query.signature, 1, here);
  return nearest.empty() ? kMostLag : nearest.front().distance - query.least_distance;
}

/// Each distinct answer once, the most probable first, with its log-odds among all places.
std::vector<PlaceAnswer> RunPlaceMap::concluded(Found found, const Query& query) const {
  std::vector<PlaceAnswer> answers;
  Found distinct = distinct_places_found(std::move(found), options_);
  for (FoundPlace& one : distinct) {
    one.voices.signature_lag = signature_lag(query, one.answer.T_map_lidar.translation());
    one.voices.beyond_best = compared(one.answer.evidence, distinct.front().answer.evidence);
  }
  for (FoundPlace& one : distinct) {
    one.answer.log_odds = place_log_odds(one.voices);
    const Evidence voices = evidence_of(one.voices);
    one.answer.evidence.insert(one.answer.evidence.begin(), voices.begin(), voices.end());
    answers.push_back(std::move(one.answer));
  }
  tell_rivals_apart(answers, verdicts(answers, query.scan));
  std::stable_sort(answers.begin(), answers.end(),
                   [](const PlaceAnswer& a, const PlaceAnswer& b) { return a.log_odds > b.log_odds; });
  return answers;
}

/// What submaps that stand alike say of each rival; of one alone nothing is asked.
std::vector<std::optional<double>> RunPlaceMap::verdicts(const std::vector<PlaceAnswer>& answers,
                                                         const PreparedScan& scan) const {
  const std::vector<std::size_t> rivals = rivals_among(answers);
  std::vector<std::optional<double>> verdicts(answers.size());
  if (rivals.size() > 1) {
    parallel_for(rivals.size(), [&](std::size_t i) {
      verdicts[rivals[i]] = registration_.verdict(scan, answers[rivals[i]].T_map_lidar);
    });
  }
  return verdicts;
}

}  // namespace

std::shared_ptr<const PlaceMap> open_place_map(const RunFolder& run, const SolvedMap& solved,
                                               const RelocalizationOptions& options, const EngineOptions& engine,
                                               const std::vector<std::size_t>& left_out) {
  check(options);
  return std::make_shared<RunPlaceMap>(run, solved, options, engine,
                                       std::set<std::size_t>(left_out.begin(), left_out.end()));
}

}  // namespace loopmark

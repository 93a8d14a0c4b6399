// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/run_place_map.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "found_place.hpp"
#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/places/place_index.hpp"
#include "lru_cache.hpp"
#include "place_centers.hpp"
#include "place_confidence.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kSubmapKeyframes = 5;  ///< at most, the nearest ones
constexpr std::size_t kCachedSubmaps = 128;
constexpr double kCenterShare = 0.5;  ///< of place_radius_m: a keyframe is at most so far from its submap's center
constexpr std::size_t kMatchesPerPlace = 6;  ///< keyframes asked of the index for each place wanted
constexpr double kKeyframeVoxel = 0.2;       ///< metres; as keyframes are kept by default
constexpr double kLeastLogOdds = -5.0;       ///< modes below it say nothing
constexpr double kSuspectLogOdds = -1.5;     ///< from here on the twins of a place are asked too

/// Whether answers are alternatives to each other.
enum class Scope { kWholeMap, kEachByItself };

/// A place of the map that a scan is registered to.
struct Asked {
  std::size_t center = 0;
  double signature_lag = 0.0;
};

std::vector<FoundPlace> joined(std::vector<std::vector<FoundPlace>> parts) {
  std::vector<FoundPlace> all;
  for (std::vector<FoundPlace>& part : parts) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  return all;
}

class RunPlaceMap final : public PlaceMap {
 public:
  RunPlaceMap(const RunFolder& run, const SolvedMap& solved, const RelocalizationOptions& options,
              const EngineOptions& engine, const std::vector<std::size_t>& left_out)
      : run_(run), options_(options), engine_(engine), submaps_(kCachedSubmaps) {
    const std::set<std::size_t> out(left_out.begin(), left_out.end());
    for (const Keyframe& keyframe : solved.keyframes) {
      if (solved.solution.component_of[keyframe.number] == 0 && out.count(keyframe.number) == 0) {
        index_.add(number_.size(), read_keyframe_place(run_, keyframe.number));
        number_.push_back(keyframe.number);
        T_map_keyframe_.push_back(solved.T_map_keyframe[keyframe.number]);
      }
    }
    center_ = place_centers(T_map_keyframe_, kCenterShare * options_.place_radius_m);
  }

  std::vector<PlaceAnswer> search(const PointCloud& scan, std::size_t places,
                                  const std::vector<Pose>& believed) const override {
    const PreparedScan source = prepare_scan(scan, engine_);
    const std::vector<Asked> asked = alike_places(scan, places);
    std::vector<FoundPlace> found = joined({verify(source, believed), register_to(source, asked)});
    std::vector<FoundPlace> of_twins = register_to(source, twins(found, asked));
    return concluded(joined({std::move(found), std::move(of_twins)}), source, Scope::kWholeMap);
  }

  std::vector<PlaceAnswer> judge(const PointCloud& scan, const std::vector<Pose>& believed) const override {
    const PreparedScan source = prepare_scan(scan, engine_);
    return concluded(verify(source, believed), source, Scope::kEachByItself);
  }

  std::vector<Eigen::Vector3d> points_around(const Eigen::Vector3d& position, double radius) const override {
    std::vector<Eigen::Vector3d> points;
    for (const std::size_t k : keyframes_within(position, 0.7 * radius)) {
      for (const Eigen::Vector3f& p : read_keyframe_cloud(run_, number_[k]).points) {
        const Eigen::Vector3d q = T_map_keyframe_[k] * p.cast<double>();
        if ((q - position).norm() < radius) {
          points.push_back(q);
        }
      }
    }
    return points;
  }

 private:
  double distance(std::size_t a, const Eigen::Vector3d& position) const {
    return (T_map_keyframe_[a].translation() - position).norm();
  }
  std::vector<std::size_t> keyframes_within(const Eigen::Vector3d& position, double radius) const;
  std::optional<std::size_t> nearest_center(const Eigen::Vector3d& position) const;
  std::vector<Asked> alike_places(const PointCloud& scan, std::size_t places) const;
  std::vector<Asked> distinct_places(const std::vector<PlaceMatch>& matches, std::size_t places,
                                     std::vector<std::size_t> known) const;
  std::vector<Asked> twins(const std::vector<FoundPlace>& found, const std::vector<Asked>& asked) const;
  PreparedScan submap(std::size_t center) const;
  std::vector<FoundPlace> register_to(const PreparedScan& source, const std::vector<Asked>& asked) const;
  std::vector<FoundPlace> verify(const PreparedScan& source, const std::vector<Pose>& believed) const;
  std::vector<FoundPlace> modes(const RegistrationResult& result, const Asked& asked) const;
  std::vector<PlaceAnswer> concluded(std::vector<FoundPlace> found, const PreparedScan& source, Scope scope) const;

  RunFolder run_;
  RelocalizationOptions options_;
  EngineOptions engine_;
  std::vector<Pose> T_map_keyframe_;
  std::vector<std::size_t> number_;  ///< of the keyframe's files
  std::vector<std::size_t> center_;  ///< of each keyframe, the keyframe at the center of its submap
  PlaceIndex index_;
  mutable LruCache<PreparedScan> submaps_;
};

std::vector<std::size_t> RunPlaceMap::keyframes_within(const Eigen::Vector3d& position, double radius) const {
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < T_map_keyframe_.size(); ++k) {
    if (distance(k, position) < radius) {
      near.push_back(k);
    }
  }
  return near;
}

std::optional<std::size_t> RunPlaceMap::nearest_center(const Eigen::Vector3d& position) const {
  const std::vector<std::size_t> near = keyframes_within(position, 2.0 * options_.place_radius_m);
  const auto nearest = std::min_element(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    return distance(a, position) < distance(b, position);
  });
  return nearest == near.end() ? std::nullopt : std::optional(center_[*nearest]);
}

/// The first keyframes of `matches`, no two of one place nor of one that is `known`.
std::vector<Asked> RunPlaceMap::distinct_places(const std::vector<PlaceMatch>& matches, std::size_t places,
                                                std::vector<std::size_t> known) const {
  std::vector<Asked> chosen;
  for (const PlaceMatch& match : matches) {
    const std::size_t center = center_[match.id];
    const bool there = std::any_of(known.begin(), known.end(), [&](std::size_t other) {
      return distance(other, T_map_keyframe_[center].translation()) < options_.place_radius_m;
    });
    if (!there && chosen.size() < places) {
      known.push_back(center);
      chosen.push_back({center, match.distance - matches.front().distance});
    }
  }
  return chosen;
}

std::vector<Asked> RunPlaceMap::alike_places(const PointCloud& scan, std::size_t places) const {
  if (places == 0) {
    return {};
  }
  const PlaceSignature signature = place_of(voxel_downsampled(scan, kKeyframeVoxel));
  return distinct_places(index_.query(signature, kMatchesPerPlace * places), places, {});
}

/// Places that look like the one where the scan was found and were not asked: one of them may be where it is.
std::vector<Asked> RunPlaceMap::twins(const std::vector<FoundPlace>& found, const std::vector<Asked>& asked) const {
  const auto best = std::max_element(found.begin(), found.end(), [](const FoundPlace& a, const FoundPlace& b) {
    return a.voices.registration < b.voices.registration;
  });
  if (asked.empty() || best == found.end() || best->voices.registration < kSuspectLogOdds) {
    return {};
  }
  std::vector<std::size_t> known;
  std::transform(asked.begin(), asked.end(), std::back_inserter(known), [](const Asked& a) { return a.center; });
  const Eigen::Vector3d here = T_map_keyframe_[best->center].translation();
  const auto elsewhere = [&](std::size_t id) { return distance(id, here) > 2.0 * options_.place_radius_m; };
  const PlaceSignature signature = read_keyframe_place(run_, number_[best->center]);
  return distinct_places(index_.query(signature, kMatchesPerPlace * options_.twins, elsewhere), options_.twins, known);
}

PreparedScan RunPlaceMap::submap(std::size_t center) const {
  return submaps_.get(center, [&] {
    const Eigen::Vector3d position = T_map_keyframe_[center].translation();
    std::vector<std::size_t> near = keyframes_within(position, options_.place_radius_m);
    std::stable_sort(near.begin(), near.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a, position) < distance(b, position); });
    near.resize(std::min(near.size(), kSubmapKeyframes));
    std::vector<PointCloud> clouds;
    std::vector<Pose> T_submap_scan;
    for (const std::size_t k : near) {
      clouds.push_back(read_keyframe_cloud(run_, number_[k]));
      T_submap_scan.push_back(T_map_keyframe_[center].inverse() * T_map_keyframe_[k]);
    }
    return prepare_submap(clouds, T_submap_scan, engine_);
  });
}

std::vector<FoundPlace> RunPlaceMap::modes(const RegistrationResult& result, const Asked& asked) const {
  const Pose& T_map_center = T_map_keyframe_[asked.center];
  const Matrix6d to_map = adjoint(T_map_center);
  const std::vector<double> log_odds = log_odds_of_modes(result);
  std::vector<FoundPlace> found;
  for (std::size_t i = 0; i < log_odds.size(); ++i) {
    if (log_odds[i] >= kLeastLogOdds) {
      FoundPlace one;
      one.answer.T_map_lidar = T_map_center * result.modes[i].T_target_source;
      one.answer.covariance = to_map * result.covariance * to_map.transpose();
      one.answer.evidence = result.modes[i].evidence;
      one.voices = {log_odds[i], 1.0, asked.signature_lag};
      one.center = asked.center;
      one.own_covariance = i == 0;
      one.centers = {asked.center};
      found.push_back(std::move(one));
    }
  }
  return found;
}

std::vector<FoundPlace> RunPlaceMap::register_to(const PreparedScan& source, const std::vector<Asked>& asked) const {
  std::vector<std::vector<FoundPlace>> each(asked.size());
  parallel_for(asked.size(), [&](std::size_t i) {
    each[i] = modes(register_scans(source, submap(asked[i].center), engine_), asked[i]);
  });
  return joined(std::move(each));
}

/// The poses that are believed, judged as those that were searched are.
std::vector<FoundPlace> RunPlaceMap::verify(const PreparedScan& source, const std::vector<Pose>& believed) const {
  std::vector<std::vector<FoundPlace>> each(believed.size());
  parallel_for(believed.size(), [&](std::size_t i) {
    if (const auto center = nearest_center(believed[i].translation())) {
      const Pose T_center_source = T_map_keyframe_[*center].inverse() * believed[i];
      each[i] = modes(verify_motion(source, submap(*center), T_center_source, engine_), {*center, 0.0});
    }
  });
  return joined(std::move(each));
}

/// Each distinct answer once, the most probable first.
std::vector<PlaceAnswer> RunPlaceMap::concluded(std::vector<FoundPlace> found, const PreparedScan& source,
                                                Scope scope) const {
  std::vector<PlaceAnswer> answers;
  std::vector<FoundPlace> distinct = distinct_places_found(std::move(found), options_);
  const Evidence best = distinct.empty() ? Evidence() : distinct.front().answer.evidence;
  for (FoundPlace& one : distinct) {
    one.voices.beyond_best = compared(one.answer.evidence, best);
    if (answers.empty() && !one.own_covariance) {
      const Pose& T_map_center = T_map_keyframe_[one.center];
      const Matrix6d to_map = adjoint(T_map_center);
      const auto judged =
          verify_motion(source, submap(one.center), T_map_center.inverse() * one.answer.T_map_lidar, engine_);
      one.answer.covariance = to_map * judged.covariance * to_map.transpose();
    }
    one.answer.log_odds = scope == Scope::kWholeMap ? place_log_odds(one.voices) : one.voices.registration;
    const Evidence voices = evidence_of(one.voices);
    one.answer.evidence.insert(one.answer.evidence.begin(), voices.begin(), voices.end());
    answers.push_back(std::move(one.answer));
  }
  std::stable_sort(answers.begin(), answers.end(),
                   [](const PlaceAnswer& a, const PlaceAnswer& b) { return a.log_odds > b.log_odds; });
  return answers;
}

}  // namespace

std::shared_ptr<const PlaceMap> open_place_map(const RunFolder& run, const SolvedMap& solved,
                                               const RelocalizationOptions& options, const EngineOptions& engine,
                                               const std::vector<std::size_t>& left_out) {
  check(options);
  return std::make_shared<RunPlaceMap>(run, solved, options, engine, left_out);
}

}  // namespace loopmark

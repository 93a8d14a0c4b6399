// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/slam/run_place_map.hpp"

#include <algorithm>
#include <list>
#include <map>
#include <mutex>
#include <utility>

#include "keyframe_files.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/places/place_index.hpp"

namespace loopmark {
namespace {

constexpr std::size_t kSubmapKeyframes = 5;  ///< at most, the nearest ones
constexpr std::size_t kCachedSubmaps = 64;
constexpr std::size_t kMatchesPerPlace = 6;  ///< keyframes asked of the index for each place wanted
constexpr double kKeyframeVoxel = 0.2;       ///< metres; as keyframes are kept by default
constexpr double kLeastP = 0.02;             ///< modes below it say nothing

/// Values kept by number, those used longest ago dropped first.
template <class Value>
class Cache {
 public:
  explicit Cache(std::size_t capacity) : capacity_(capacity) {}

  template <class Make>
  Value get(std::size_t key, const Make& make) {
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = values_.find(key); found != values_.end()) {
        order_.splice(order_.begin(), order_, found->second.second);
        return found->second.first;
      }
    }
    Value value = make();
    const std::scoped_lock lock(mutex_);
    if (values_.count(key) == 0) {
      order_.push_front(key);
      values_.emplace(key, std::pair(value, order_.begin()));
      if (values_.size() > capacity_) {
        values_.erase(order_.back());
        order_.pop_back();
      }
    }
    return value;
  }

 private:
  std::size_t capacity_;
  std::mutex mutex_;
  std::list<std::size_t> order_;
  std::map<std::size_t, std::pair<Value, std::list<std::size_t>::iterator>> values_;
};

class RunPlaceMap final : public PlaceMap {
 public:
  RunPlaceMap(const RunFolder& run, const SolvedMap& solved, const RelocalizationOptions& options,
              const EngineOptions& engine)
      : run_(run), options_(options), engine_(engine), submaps_(kCachedSubmaps) {
    for (const Keyframe& keyframe : solved.keyframes) {
      if (solved.solution.component_of[keyframe.number] == 0) {
        index_.add(number_.size(), read_keyframe_place(run_, keyframe.number));
        number_.push_back(keyframe.number);
        T_map_keyframe_.push_back(solved.T_map_keyframe[keyframe.number]);
      }
    }
  }

  std::vector<PlaceAnswer> search(const PointCloud& scan, std::size_t places) const override {
    const std::vector<std::size_t> chosen = alike_places(scan, places);
    const PreparedScan source = prepare_scan(scan, engine_);
    std::vector<std::vector<PlaceAnswer>> found(chosen.size());
    parallel_for(chosen.size(), [&](std::size_t i) { found[i] = register_to(source, chosen[i]); });
    std::vector<PlaceAnswer> answers;
    for (const std::vector<PlaceAnswer>& some : found) {
      answers.insert(answers.end(), some.begin(), some.end());
    }
    return answers;
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
  std::vector<std::size_t> keyframes_within(const Eigen::Vector3d& position, double radius) const;
  std::vector<std::size_t> alike_places(const PointCloud& scan, std::size_t places) const;
  PreparedScan submap(std::size_t center) const;
  std::vector<PlaceAnswer> register_to(const PreparedScan& source, std::size_t center) const;

  RunFolder run_;
  RelocalizationOptions options_;
  EngineOptions engine_;
  std::vector<Pose> T_map_keyframe_;
  std::vector<std::size_t> number_;  ///< of the keyframe's files
  PlaceIndex index_;
  mutable Cache<PreparedScan> submaps_;
};

std::vector<std::size_t> RunPlaceMap::keyframes_within(const Eigen::Vector3d& position, double radius) const {
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < T_map_keyframe_.size(); ++k) {
    if ((T_map_keyframe_[k].translation() - position).norm() < radius) {
      near.push_back(k);
    }
  }
  return near;
}

/// Keyframes that look like the scan, no two of one place.
std::vector<std::size_t> RunPlaceMap::alike_places(const PointCloud& scan, std::size_t places) const {
  std::vector<std::size_t> chosen;
  for (const PlaceMatch& match :
       index_.query(place_of(voxel_downsampled(scan, kKeyframeVoxel)), kMatchesPerPlace * places)) {
    const bool known = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t other) {
      return (T_map_keyframe_[other].translation() - T_map_keyframe_[match.id].translation()).norm() <
             options_.place_radius_m;
    });
    if (!known && chosen.size() < places) {
      chosen.push_back(match.id);
    }
  }
  return chosen;
}

PreparedScan RunPlaceMap::submap(std::size_t center) const {
  return submaps_.get(center, [&] {
    const Eigen::Vector3d position = T_map_keyframe_[center].translation();
    std::vector<std::size_t> near = keyframes_within(position, options_.place_radius_m);
    std::stable_sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
      return (T_map_keyframe_[a].translation() - position).norm() <
             (T_map_keyframe_[b].translation() - position).norm();
    });
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

std::vector<PlaceAnswer> RunPlaceMap::register_to(const PreparedScan& source, std::size_t center) const {
  const RegistrationResult result = register_scans(source, submap(center), engine_);
  const Matrix6d to_map = adjoint(T_map_keyframe_[center]);
  std::vector<PlaceAnswer> answers;
  for (const RegistrationMode& mode : result.modes) {
    if (mode.p_correct >= kLeastP) {
      answers.push_back({T_map_keyframe_[center] * mode.T_target_source,
                         to_map * result.covariance * to_map.transpose(), mode.p_correct});
    }
  }
  return answers;
}

}  // namespace

std::shared_ptr<const PlaceMap> open_place_map(const RunFolder& run, const SolvedMap& solved,
                                               const RelocalizationOptions& options, const EngineOptions& engine) {
  check(options);
  return std::make_shared<RunPlaceMap>(run, solved, options, engine);
}

}  // namespace loopmark

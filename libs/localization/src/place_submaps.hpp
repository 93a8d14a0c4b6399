// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/registration/engine.hpp"
#include "lru_cache.hpp"

namespace loopmark::localization::internal {

/// The keyframes of a map's main part, and submaps of them that registration can use: around fixed centers, joined when
/// they are first asked for. Keyframes count from 0 here, whatever their number in the run. Calls may come from several
/// threads.
class PlaceSubmaps {
 public:
  /// Without the keyframes whose numbers are `left_out`. Keyframes nearer than `radius_m` to a center form its submap.
  PlaceSubmaps(const map_store::RunFolder& run, const mapping::SolvedMap& solved, const std::set<std::size_t>& left_out,
               double radius_m, const registration::EngineOptions& engine);

  std::size_t size() const { return T_map_keyframe_.size(); }
  const Pose& T_map_keyframe(std::size_t k) const { return T_map_keyframe_[k]; }
  std::size_t number(std::size_t k) const { return number_[k]; }     ///< of its files in the run
  std::size_t center_of(std::size_t k) const { return center_[k]; }  ///< the keyframe in the middle of its submap

  double distance(std::size_t k, const Eigen::Vector3d& position) const {
    return (T_map_keyframe_[k].translation() - position).norm();
  }
  std::vector<std::size_t> within(const Eigen::Vector3d& position, double radius_m) const;

  /// The center of the keyframe nearest to a position; nothing where that is farther than twice the radius.
  std::optional<std::size_t> nearest_center(const Eigen::Vector3d& position) const;

  /// The centers of the submaps that tell most about a pose at a position: the nearest, and one that stands off. (The
  /// engine knows that scans are alike around their own sensors, and distrusts short motions.) None far from the map.
  std::vector<std::size_t> judges_of(const Eigen::Vector3d& position) const;

  /// The submap around a center, in the center's frame. Throws InputError when a keyframe's file cannot be read.
  registration::PreparedScan prepared(std::size_t center) const;

 private:
  registration::PreparedScan joined_around(std::size_t center) const;

  map_store::RunFolder run_;
  double radius_m_;
  registration::EngineOptions engine_;
  std::vector<Pose> T_map_keyframe_;
  std::vector<std::size_t> number_;
  std::vector<std::size_t> center_;
  mutable LruCache<registration::PreparedScan> prepared_;
};

}  // namespace loopmark::localization::internal

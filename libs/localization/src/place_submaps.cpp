// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_submaps.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/map_store/keyframe_files.hpp"
#include "place_centers.hpp"

namespace loopmark::localization::internal {
namespace {

constexpr std::size_t kKeyframes = 5;  ///< of a submap at most, the nearest ones
constexpr std::size_t kKept = 128;     ///< submaps in memory
constexpr double kStandOff = 25.0;     ///< metres
constexpr double kCenterShare = 0.5;   ///< of the radius: a keyframe is at most so far from its submap's center

}  // namespace

PlaceSubmaps::PlaceSubmaps(const map_store::RunFolder& run, const mapping::SolvedMap& solved,
                           const std::set<std::size_t>& left_out, double radius_m,
                           const registration::EngineOptions& engine)
    : run_(run), radius_m_(radius_m), engine_(engine), prepared_(kKept) {
  for (const mapping::Keyframe& keyframe : solved.keyframes) {
    if (solved.solution.component_of[keyframe.number] == 0 && left_out.count(keyframe.number) == 0) {
      number_.push_back(keyframe.number);
      T_map_keyframe_.push_back(solved.T_map_keyframe[keyframe.number]);
    }
  }
  center_ = place_centers(T_map_keyframe_, kCenterShare * radius_m_);
}

std::vector<std::size_t> PlaceSubmaps::within(const Eigen::Vector3d& position, double radius_m) const {
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < size(); ++k) {
    if (distance(k, position) < radius_m) {
      near.push_back(k);
    }
  }
  return near;
}

std::optional<std::size_t> PlaceSubmaps::nearest_center(const Eigen::Vector3d& position) const {
  const std::vector<std::size_t> near = within(position, 2.0 * radius_m_);
  const auto nearest = std::min_element(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    return distance(a, position) < distance(b, position);
  });
  return nearest == near.end() ? std::nullopt : std::optional(center_[*nearest]);
}

std::vector<std::size_t> PlaceSubmaps::judges_of(const Eigen::Vector3d& position) const {
  std::vector<std::size_t> judges;
  if (const auto nearest = nearest_center(position)) {
    judges.push_back(*nearest);
    const std::vector<std::size_t> around = within(position, 2.0 * kStandOff);
    const auto off = [&](std::size_t k) { return std::abs(distance(center_[k], position) - kStandOff); };
    const std::size_t aside =
        *std::min_element(around.begin(), around.end(), [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
    if (center_[aside] != *nearest) {
      judges.push_back(center_[aside]);
    }
  }
  return judges;
}

registration::PreparedScan PlaceSubmaps::prepared(std::size_t center) const {
  return prepared_.get(center, [&] { return joined_around(center); });
}

registration::PreparedScan PlaceSubmaps::joined_around(std::size_t center) const {
  const Eigen::Vector3d position = T_map_keyframe_[center].translation();
  std::vector<std::size_t> near = within(position, radius_m_);
  std::stable_sort(near.begin(), near.end(),
                   [&](std::size_t a, std::size_t b) { return distance(a, position) < distance(b, position); });
  near.resize(std::min(near.size(), kKeyframes));
  std::vector<PointCloud> clouds;
  std::vector<Pose> T_submap_scan;
  for (const std::size_t k : near) {
    clouds.push_back(map_store::read_keyframe_cloud(run_, number_[k]));
    T_submap_scan.push_back(T_map_keyframe_[center].inverse() * T_map_keyframe_[k]);
  }
  return registration::prepare_submap(clouds, T_submap_scan, engine_);
}

}  // namespace loopmark::localization::internal

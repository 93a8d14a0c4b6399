// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/kidnap_benchmark/drill_strata.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "loopmark/core/parallel.hpp"
#include "loopmark/map_store/keyframe_files.hpp"
#include "loopmark/places/place_index.hpp"

namespace loopmark::kidnap_benchmark {
namespace {

constexpr double kAroundM = 12.0;
constexpr double kTurnDeg = 30.0;
constexpr double kSightM = 40.0;
constexpr double kStandsM = 1.0;
constexpr double kOpenShare = 0.4;
constexpr double kOnM = 3.0;
constexpr double kSameM = 10.0;
constexpr double kOtherM = 30.0;

double heading_deg(const Pose& pose) { return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)) * 180.0 / M_PI; }

double between_deg(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

/// Cells of a square metre in which points stand apart by kStandsM or more in height.
double structure_of(const PointCloud& cloud, const Pose& T_map_lidar) {
  struct Column {
    float low = 1e9F, high = -1e9F;
  };
  std::unordered_map<std::int64_t, Column> columns;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (p.head<2>().norm() > kSightM) {
      continue;
    }
    const Eigen::Vector3f q = T_map_lidar.linear().cast<float>() * p;
    const auto x = static_cast<std::int64_t>(std::floor(q.x()));
    const auto y = static_cast<std::int64_t>(std::floor(q.y()));
    Column& column = columns[x * 4096 + y];
    column.low = std::min(column.low, q.z());
    column.high = std::max(column.high, q.z());
  }
  return static_cast<double>(std::count_if(columns.begin(), columns.end(), [](const auto& entry) {
    return entry.second.high - entry.second.low >= kStandsM;
  }));
}

void look_along_the_path(const mapping::SolvedMap& map, std::size_t k, PlaceCharacter& place) {
  const mapping::Keyframe& here = map.keyframes[k];
  std::size_t before = k;
  std::size_t behind = k;
  while (before > 0 && here.path_m - map.keyframes[before - 1].path_m <= kAroundM) {
    --before;
  }
  while (behind + 1 < map.keyframes.size() && map.keyframes[behind + 1].path_m - here.path_m <= kAroundM) {
    ++behind;
  }
  place.turn_deg = between_deg(heading_deg(map.T_map_keyframe[before]), heading_deg(map.T_map_keyframe[behind]));
  const double heading = heading_deg(map.T_map_keyframe[k]);
  for (std::size_t other = 0; other < map.keyframes.size(); ++other) {
    if (std::abs(map.keyframes[other].path_m - here.path_m) > 3.0 * kAroundM &&
        (map.T_map_keyframe[other].translation() - map.T_map_keyframe[k].translation()).norm() < kAroundM) {
      const double across = between_deg(heading, heading_deg(map.T_map_keyframe[other]));
      place.crossing = place.crossing || (across > 45.0 && across < 135.0);
    }
  }
}

void look_for_twins(const mapping::SolvedMap& map, const places::PlaceIndex& index,
                    const places::PlaceDescriptor& descriptor, std::size_t k, PlaceCharacter& place) {
  const auto away = [&](std::size_t other) {
    return (map.T_map_keyframe[other].translation() - map.T_map_keyframe[k].translation()).norm();
  };
  const auto same =
      index.query(descriptor, 1, [&](std::size_t other) { return away(other) >= kOnM && away(other) <= kSameM; });
  const auto others = index.query(descriptor, 1, [&](std::size_t other) { return away(other) >= kOtherM; });
  place.same_place = same.empty() ? 0.0 : same.front().distance;
  place.other_place = others.empty() ? 2.0 : others.front().distance;
}

}  // namespace

const char* name(Stratum stratum) {
  switch (stratum) {
    case Stratum::kStraight:
      return "straight";
    case Stratum::kJunction:
      return "junction";
    case Stratum::kOpen:
      return "open";
    case Stratum::kNearIdentical:
      break;
  }
  return "near-identical";
}

Stratum stratum_of(const PlaceCharacter& place, double median_structure) {
  if (place.same_place > 0.0 && place.other_place <= place.same_place) {
    return Stratum::kNearIdentical;
  }
  if (place.structure < kOpenShare * median_structure) {
    return Stratum::kOpen;
  }
  return place.turn_deg > kTurnDeg || place.crossing ? Stratum::kJunction : Stratum::kStraight;
}

std::vector<PlaceCharacter> characterise_places(const map_store::RunFolder& run, const mapping::SolvedMap& map) {
  std::vector<PlaceCharacter> places(map.keyframes.size());
  std::vector<places::PlaceDescriptor> descriptors(map.keyframes.size());
  places::PlaceIndex index;
  for (std::size_t k = 0; k < places.size(); ++k) {
    descriptors[k] = map_store::read_keyframe_place(run, map.keyframes[k].number);
    index.add(k, descriptors[k]);
  }
  std::vector<double> structure(places.size());
  parallel_for(places.size(), [&](std::size_t k) {
    look_along_the_path(map, k, places[k]);
    look_for_twins(map, index, descriptors[k], k, places[k]);
    places[k].structure =
        structure_of(map_store::read_keyframe_cloud(run, map.keyframes[k].number), map.T_map_keyframe[k]);
    structure[k] = places[k].structure;
  });
  if (places.empty()) {
    return places;
  }
  const auto middle = structure.begin() + static_cast<std::ptrdiff_t>(structure.size() / 2);
  std::nth_element(structure.begin(), middle, structure.end());
  for (PlaceCharacter& place : places) {
    place.stratum = stratum_of(place, *middle);
  }
  return places;
}

}  // namespace loopmark::kidnap_benchmark

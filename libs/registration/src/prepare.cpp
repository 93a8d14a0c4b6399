// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "loopmark/bev/ground_alignment.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/error.hpp"
#include "prepared_data.hpp"

namespace loopmark::registration {
namespace {

constexpr float kEgo =
    3.0F;  // metres: nearer points are the car's own bonnet and roof, which would say that it stands still
constexpr float kFarthest = 120.0F;
constexpr double kLevelVoxel = 0.3;

std::vector<Eigen::Vector3f> in_range(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> kept;
  kept.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    const float range = p.norm();
    if (range > kEgo && range < kFarthest) {  // false for NaN
      kept.push_back(p);
    }
  }
  return kept;
}

std::vector<Eigen::Vector3f> moved(std::vector<Eigen::Vector3f> points, const Pose& pose) {
  const Eigen::Isometry3f T = pose.cast<float>();
  for (Eigen::Vector3f& p : points) {
    p = T * p;
  }
  return points;
}

std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, double voxel_m) {
  std::vector<Eigen::Vector3f> kept;
  for (const std::size_t i : cloud::voxel_first_indices(points, voxel_m)) {
    kept.push_back(points[i]);
  }
  return kept;
}

float rounded(float value, float step) { return std::round(value / step) * step; }

/// Rounds what to_bytes stores, so that a scan read back gives the same answers.
void round_to_stored(surfels::Surfel& surfel) {
  for (int axis = 0; axis < 3; ++axis) {
    surfel.mean[axis] = rounded(surfel.mean[axis], kMeanStep);
    surfel.normal[axis] = rounded(surfel.normal[axis], kNormalStep);
  }
  surfel.planarity = rounded(surfel.planarity, kNormalStep);
}

PreparedScan finish(PreparedScan::Data data, const std::vector<Eigen::Vector3f>& level_points) {
  std::vector<surfels::Surfel> surfels = surfels::make_surfels(level_points, kFineSurfel);
  for (surfels::Surfel& surfel : surfels) {
    round_to_stored(surfel);
  }
  derive(data, std::move(surfels));
  return PreparedScan(std::make_shared<const PreparedScan::Data>(std::move(data)));
}

}  // namespace

std::shared_ptr<const shape_context::Keypoints> LazyKeypoints::of(const surfels::SurfelMap& fine) const {
  std::shared_ptr<const shape_context::Keypoints> made = place_->made.load();
  if (made == nullptr) {
    std::vector<Eigen::Vector3f> points;
    std::vector<float> heights;
    for (const surfels::Surfel& surfel : fine.surfels()) {
      points.push_back(surfel.mean);
      heights.push_back(surfel.height);
    }
    made = std::make_shared<const shape_context::Keypoints>(shape_context::describe_structure(points, heights, {}));
    place_->made.store(made);
  }
  return made;
}

void derive(PreparedScan::Data& data, std::vector<surfels::Surfel> surfels) {
  std::vector<surfels::Surfel> distinct = surfels::SurfelMap(std::move(surfels), kFineSurfel).surfels();
  std::vector<Eigen::Vector3f> means;
  means.reserve(distinct.size());
  for (const surfels::Surfel& surfel : distinct) {
    means.push_back(surfel.mean);
  }
  data.ground = bev::GroundMap(means);
  for (surfels::Surfel& surfel : distinct) {
    surfel.height = data.ground.height_above(surfel.mean);
  }
  data.above = {bev::structure_cells(means, data.ground), bev::relief_cells(means, data.ground)};
  data.landmarks = bev::find_landmarks(data.above.structure);
  data.fine = surfels::SurfelMap(std::move(distinct), kFineSurfel);
  data.coarse = surfels::SurfelMap(surfels::coarsened(data.fine, kCoarseFactor), kFineSurfel * kCoarseFactor);
}

PreparedScan prepare_scan(const PointCloud& cloud, const EngineOptions& options) {
  return prepare_submap({cloud}, {Pose::Identity()}, options);
}

PreparedScan prepare_submap(const std::vector<PointCloud>& clouds, const std::vector<Pose>& T_submap_scan,
                            const EngineOptions& /*options*/) {
  if (clouds.size() != T_submap_scan.size() || clouds.empty()) {
    throw InputError("a submap needs one pose for each of its scans, and at least one scan");
  }
  std::vector<Eigen::Vector3f> points;
  std::vector<std::vector<Eigen::Vector3f>> seen;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    seen.push_back(in_range(clouds[i].points));
    const auto in_submap = moved(seen.back(), T_submap_scan[i]);
    points.insert(points.end(), in_submap.begin(), in_submap.end());
  }
  const bev::GroundAlignment ground_alignment = bev::find_ground_alignment(thinned(points, kLevelVoxel));
  PreparedScan::Data data;
  data.T_level_sensor = ground_alignment.T_level_sensor;
  data.ground_share = ground_alignment.ground_share;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    data.views.push_back({ground_alignment.T_level_sensor * T_submap_scan[i], RangeImage(seen[i])});
  }
  return finish(std::move(data), moved(std::move(points), ground_alignment.T_level_sensor));
}

}  // namespace loopmark::registration

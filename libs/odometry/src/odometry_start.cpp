// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How a segment begins whose sensor may be moving already.
#include <algorithm>
#include <cmath>
#include <utility>

#include "loopmark/core/parallel.hpp"
#include "loopmark/features/ground.hpp"
#include "odometry_search.hpp"

namespace loopmark::odometry {
namespace {

constexpr double kCarefulGapS = 0.3;  // between scans
constexpr double kStartM = 15.0;      // a segment starts within this distance
constexpr double kFarthest = 20.0;    // metres between the first two scans, of what is searched
constexpr double kMostSteps = 50.0;
constexpr std::size_t kMostPoints = 3000;  // of a scan's structure, for a first look

/// The points of a scan that rise from the ground, not more than kMostPoints.
PointCloud structure(const PointCloud& cloud) {
  const std::vector<bool> ground = features::ground_points(cloud.points, {});
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!ground[i]) {
      indices.push_back(i);
    }
  }
  const std::size_t stride = indices.size() / kMostPoints + 1;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < indices.size(); i += stride) {
    kept.push_back(indices[i]);
  }
  return select(cloud, kept);
}

/// How well points lie on the map: 1 for each that does, less with distance.
double fit(const surfels::LocalMap& map, const std::vector<Eigen::Vector3d>& points) {
  const double reach_m = 0.5 * map.voxel_m();
  double sum = 0.0;
  surfels::MapMatch match;
  for (const Eigen::Vector3d& point : points) {
    if (map.nearest(point, reach_m, match)) {
      sum += 1.0 - match.distance_m * match.distance_m / (reach_m * reach_m);
    }
  }
  return sum;
}

}  // namespace

/// While the motion is not sure, ground counts across its planes only, and what rises from it ranks the answers: at the
/// start of a segment, and where nothing held a direction in the last scan. Where scans are far apart in time, most of
/// what stands above the ground is new, and its rings lie elsewhere anyway.
bool Odometry::initialising(double stamp_s) const {
  return last_ && gap_to(stamp_s) < kCarefulGapS &&
         (!last_->tracking_status.degenerate_directions.empty() ||
          (last_->T_map_lidar.translation() - origin_.translation()).norm() < kStartM);
}

/// The few straight motions since the first scan of the segment that best bring together what rises from the ground.
/// Both scans are deskewed by the motion that is tried.
std::vector<Odometry::Start> Odometry::straight_starts(const TrackedScan& prepared) const {
  constexpr double kStepVoxels = 0.3;
  constexpr std::size_t kKept = 4;
  const double gap_s = gap_to(prepared.stamp_s);
  const double farthest_m = std::min(kFastest * gap_s, kFarthest);
  const double step_m = std::max(kStepVoxels * map_->voxel_m(), farthest_m / kMostSteps);
  std::vector<Start> tried;
  std::vector<double> distances_m;
  for (double distance_m = step_m; distance_m <= farthest_m; distance_m += step_m) {
    distances_m.push_back(distance_m);
  }
  for (const Pose& T_last_lidar : straight_motions(distances_m)) {
    tried.push_back({last_->T_map_lidar * T_last_lidar, log_se3(T_last_lidar) / gap_s});
  }
  TrackedScan first = *last_;
  first.sample = structure(first.sample);
  TrackedScan second = prepared;
  second.sample = structure(second.sample);
  std::vector<std::pair<double, std::size_t>> order(tried.size());  // minus the fit: the best comes first
  parallel_for(tried.size(), [&](std::size_t i) {
    TrackedScan before = first;
    TrackedScan now = second;
    before.sweep_velocity = now.sweep_velocity = tried[i].velocity;
    now.T_map_lidar = tried[i].T_map_lidar;
    surfels::LocalMap map(map_->voxel_m(), options_.points_per_voxel);
    map.insert(in_map(before));
    order[i] = {-fit(map, in_map(now)), i};
  });
  std::sort(order.begin(), order.end());
  std::vector<Start> kept;
  for (const auto& [misfit, i] : order) {
    const Eigen::Vector3d place = tried[i].T_map_lidar.translation();
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Start& start) {
      return (start.T_map_lidar.translation() - place).norm() < map_->voxel_m();
    });
    if (!known && kept.size() < kKept) {
      kept.push_back(tried[i]);
    }
  }
  return kept;
}

}  // namespace loopmark::odometry

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What of a scan the odometry works on: points in range, thinned, deskewed.
#include <algorithm>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/features/ground.hpp"
#include "odometry_search.hpp"

namespace loopmark::odometry {
namespace {

constexpr double kSampleVoxels = 0.5;  // points for the map: one in a cell of this many voxels

std::vector<std::size_t> in_range(const std::vector<Eigen::Vector3f>& points, const OdometryOptions& options) {
  const auto least = static_cast<float>(options.min_range_m * options.min_range_m);
  const auto most = static_cast<float>(options.max_range_m * options.max_range_m);
  std::vector<std::size_t> kept;
  kept.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float range = points[i].squaredNorm();  // NaN fails both comparisons
    if (range > least && range < most) {
      kept.push_back(i);
    }
  }
  return kept;
}

/// Middle of the sweep against the scan's stamp, seconds.
double middle_of_sweep(const std::vector<float>& times) {
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  return 0.5 * (static_cast<double>(*first) + static_cast<double>(*last));
}

}  // namespace

bool Odometry::deskews() const {
  return compensation_ == Compensation::kRawGivenTimes || compensation_ == Compensation::kRawClockwise ||
         compensation_ == Compensation::kRawCounterClockwise;
}

std::vector<float> Odometry::times(const PointCloud& cloud) const {
  if (compensation_ == Compensation::kRawGivenTimes) {
    return cloud.time_offset_s;
  }
  return cloud::times_from_azimuth(cloud.points, sweep_);
}

TrackedScan Odometry::prepare(const Scan& scan) const {
  TrackedScan tracked;
  tracked.index = scan.index;
  tracked.stamp_s = scan.stamp_s;
  PointCloud thin;
  const bool timed = deskews() && scan.cloud.time_offset_s.size() == scan.cloud.size();
  for (const std::size_t i : in_range(scan.cloud.points, options_)) {
    thin.points.push_back(scan.cloud.points[i]);
    if (timed) {
      thin.time_offset_s.push_back(scan.cloud.time_offset_s[i]);
    }
  }
  const double voxel_m = map_                     ? map_->voxel_m()
                         : options_.voxel_m > 0.0 ? options_.voxel_m
                                                  : voxel_for_scene(thin.points);
  tracked.sample = select(thin, cloud::voxel_central_indices(thin.points, kSampleVoxels * voxel_m));
  if (deskews()) {
    tracked.sample.time_offset_s = times(tracked.sample);
  }
  return tracked;
}

/// The mean since the last scan lags behind by half a scan. How fast a car turns changes within tenths of a second, and
/// a wrong turn bends the scan, so the rate of turn about the sensor's upright axis is carried on to the middle of the
/// sweep. Roll and pitch are left: their rates are noise for the better part, and carrying on doubles it.
Vector6d Odometry::during_sweep(const TrackedScan& tracked) const {
  Vector6d velocity = tracked.velocity;
  const std::vector<float>& times = tracked.sample.time_offset_s;
  const double gap_s = gap_to(tracked.stamp_s);
  if (committed_ < 2 || times.empty() || !even(gap_s, last_gap_s_)) {
    return velocity;
  }
  const double ahead_s = 0.5 * gap_s + middle_of_sweep(times);
  velocity[5] += (velocity[5] - last_->velocity[5]) * ahead_s / (0.5 * (gap_s + last_gap_s_));
  return velocity;
}

Vector6d Odometry::sweep_of_last(const TrackedScan& next) const {
  const double gap_s = gap_to(next.stamp_s);
  const std::vector<float>& times = last_->sample.time_offset_s;
  if (committed_ == 1) {
    return next.velocity;
  }
  if (times.empty() || !even(gap_s, last_gap_s_)) {
    return last_->sweep_velocity;
  }
  const double share = (0.5 * last_gap_s_ + middle_of_sweep(times)) / (0.5 * (gap_s + last_gap_s_));
  return last_->velocity + share * (next.velocity - last_->velocity);
}

std::vector<Eigen::Vector3f> Odometry::deskewed_sample(const TrackedScan& tracked) const {
  return deskews() ? cloud::deskewed(tracked.sample.points, tracked.sample.time_offset_s, tracked.sweep_velocity)
                   : tracked.sample.points;
}

std::vector<Eigen::Vector3d> Odometry::in_map(const TrackedScan& tracked) const {
  const std::vector<Eigen::Vector3f> points = deskewed_sample(tracked);
  std::vector<Eigen::Vector3d> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(),
                 [&](const Eigen::Vector3f& p) { return tracked.T_map_lidar * p.cast<double>(); });
  return result;
}

Keypoints Odometry::keypoints(const TrackedScan& tracked, double cell_m) const {
  const std::vector<Eigen::Vector3f> points = deskewed_sample(tracked);
  Keypoints result;
  for (const std::size_t i : cloud::voxel_central_indices(points, cell_m)) {
    result.points.push_back(points[i]);
  }
  if (committed_ == 1 ||
      initialising(tracked.stamp_s)) {  // before motion is sure, rings on the ground must not say that there is none
    result.ground = features::ground_points(result.points, {});
  }
  return result;
}

PointCloud Odometry::deskewed_cloud(const Scan& scan, const Vector6d& velocity) const {
  PointCloud cloud = select(scan.cloud, in_range(scan.cloud.points, options_));
  if (deskews()) {
    cloud.points = cloud::deskewed(cloud.points, times(cloud), velocity);
  }
  return cloud;
}

double voxel_for_scene(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kVoxelsAcross = 15.0;
  constexpr double kLeast = 0.3;
  constexpr double kMost = 1.0;
  if (points.empty()) {
    return kMost;
  }
  std::vector<float> ranges(points.size());
  std::transform(points.begin(), points.end(), ranges.begin(), [](const Eigen::Vector3f& p) { return p.norm(); });
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() * 9 / 10);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return std::clamp(static_cast<double>(*middle) / kVoxelsAcross, kLeast, kMost);
}

}  // namespace loopmark::odometry

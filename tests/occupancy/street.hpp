// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Scans of a made-up street, and OctoMap's own way of mapping them.
#pragma once

#include <octomap/OcTree.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "loopmark/core/random.hpp"
#include "loopmark/occupancy/occupancy_map.hpp"

namespace loopmark::testing {

struct StreetScan {
  std::vector<Eigen::Vector3f> points;
  Pose T_map_sensor = Pose::Identity();
};

/// Rays over all azimuths and a few elevations from (x, 0, 1.8): to the ground, to walls at y = +-8 and to a car.
inline StreetScan street_scan(double x, double yaw, std::size_t rays, Rng& rng) {
  StreetScan scan;
  scan.T_map_sensor = pose_from_yaw(yaw, {x, 0.3, 1.8});
  for (std::size_t i = 0; i < rays; ++i) {
    const double azimuth = rng.uniform(0.0, 2.0 * std::numbers::pi);
    const double elevation = rng.uniform(-0.4, 0.15);
    const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation));
    double range = d.z() < 0.0 ? 1.8 / -d.z() : 200.0;
    range = std::min(range, 7.7 / std::max(std::abs(d.y()), 0.02)) + 0.02 * rng.normal();
    const Eigen::Vector3d p = range * d;
    scan.points.push_back((rotation_from_euler_degrees({0, 0, -yaw * 180.0 / std::numbers::pi}) * p).cast<float>());
  }
  return scan;
}

inline std::vector<StreetScan> street(std::size_t scans, std::size_t rays) {
  Rng rng(7);
  std::vector<StreetScan> list;
  for (std::size_t i = 0; i < scans; ++i) {
    list.push_back(street_scan(4.0 * static_cast<double>(i) - 9.0, 0.3 * static_cast<double>(i), rays, rng));
  }
  return list;
}

/// One octomap insertion a scan, as a user of OctoMap would do it.
inline void insert_with_octomap(octomap::OcTree& tree, const StreetScan& scan, double max_range) {
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3f& p : scan.points) {
    const Eigen::Vector3f q = (scan.T_map_sensor * p.cast<double>()).cast<float>();
    cloud.push_back(q.x(), q.y(), q.z());
  }
  const Eigen::Vector3f origin = scan.T_map_sensor.translation().cast<float>();
  tree.insertPointCloud(cloud, octomap::point3d(origin.x(), origin.y(), origin.z()), max_range);
}

}  // namespace loopmark::testing

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/shape_context/fourier_shape_context.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "keypoints.hpp"
#include "loopmark/bev/ground_alignment.hpp"
#include "loopmark/bev/ground_map.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/search/voxel_table.hpp"
#include "ring_spectrum.hpp"

namespace loopmark::shape_context {
namespace {

static_assert(kDimension == internal::kSpectrum);

constexpr float kUnit = 512.0F;        // whole numbers to 1: hardly any of the numbers is larger than 127 / 512
constexpr float kNearest = 1.5F;       // metres: nearer points are the vehicle's own
constexpr float kFarthest = 90.0F;     // metres
constexpr float kVoxel = 0.3F;         // metres
constexpr std::size_t kTogether = 64;  // keypoints of one task

void write_row(const internal::PolarHistogram& histogram, std::int8_t* row) {
  std::array<float, internal::kSpectrum> spectrum;
  internal::ring_spectrum(histogram, spectrum.data());
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    row[i] = static_cast<std::int8_t>(std::clamp(std::lround(spectrum[i] * kUnit), -127L, 127L));
  }
}

/// The points in range, one a voxel.
std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> kept;
  search::VoxelTable table(points.size() / 4);
  for (const Eigen::Vector3f& p : points) {
    const float range = p.norm();
    if (range > kNearest && range < kFarthest) {  // false for NaN
      const std::size_t known = table.size();
      if (table.insert(search::voxel_of(p, 1.0F / kVoxel)) == known) {
        kept.push_back(p);
      }
    }
  }
  return kept;
}

}  // namespace

Keypoints describe_structure(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& heights,
                             const Options& options) {
  check(options);
  if (points.size() != heights.size()) {
    throw std::invalid_argument("describe_structure: one height for each point is needed");
  }
  Keypoints out;
  out.points = internal::choose_keypoints(points, heights, options);
  out.descriptors.resize(static_cast<Eigen::Index>(out.points.size()), kDimension);
  const internal::StructureColumns columns(points, heights);
  const auto radius = static_cast<float>(options.radius_m);
  parallel_for(
      out.points.size(),
      [&](std::size_t i) {
        write_row(columns.around(out.points[i].x(), out.points[i].y(), radius),
                  out.descriptors.row(static_cast<Eigen::Index>(i)).data());
      },
      kTogether);
  return out;
}

Keypoints describe_scan(const std::vector<Eigen::Vector3f>& points, const Options& options) {
  std::vector<Eigen::Vector3f> scan = thinned(points);
  const Eigen::Isometry3f T_level_sensor = bev::find_ground_alignment(scan).T_level_sensor.cast<float>();
  for (Eigen::Vector3f& p : scan) {
    p = T_level_sensor * p;
  }
  const bev::GroundMap ground(scan);
  std::vector<float> heights;
  heights.reserve(scan.size());
  for (const Eigen::Vector3f& p : scan) {
    heights.push_back(ground.height_above(p));
  }
  Keypoints out = describe_structure(scan, heights, options);
  const Eigen::Isometry3f T_sensor_level = T_level_sensor.inverse();
  for (Eigen::Vector3f& p : out.points) {
    p = T_sensor_level * p;
  }
  return out;
}

}  // namespace loopmark::shape_context

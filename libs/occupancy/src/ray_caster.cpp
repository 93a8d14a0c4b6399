// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ray_caster.hpp"

#include <algorithm>
#include <limits>

#include "loopmark/core/error.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::occupancy::internal {
namespace {

/// One axis of a walk.
struct Axis {
  double next = std::numeric_limits<double>::max();   ///< ray length at the next border
  double delta = std::numeric_limits<double>::max();  ///< ray length across one voxel
  std::int64_t step = 0;                              ///< change of the bit's place

  Axis(float origin, float direction, int key, double resolution, std::int64_t stride) {
    if (direction == 0.0F) {
      return;
    }
    const int sign = direction > 0.0F ? 1 : -1;
    double border = centre_of(key, resolution);
    border += static_cast<float>(sign * resolution * 0.5);
    next = (border - static_cast<double>(origin)) / static_cast<double>(direction);
    delta = resolution / std::fabs(static_cast<double>(direction));
    step = sign * stride;
  }
};

float length_of(const Eigen::Vector3f& v) {
  return static_cast<float>(std::sqrt(static_cast<double>(v.x() * v.x() + v.y() * v.y() + v.z() * v.z())));
}

}  // namespace

RayCaster::RayCaster(const OccupancyOptions& options)
    : resolution_(options.resolution_m),
      inverse_resolution_(1.0 / options.resolution_m),
      max_range_(options.max_range_m) {}

void RayCaster::make_rays(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& origin,
                          const Key& origin_key) {
  rays_.clear();
  Key low = origin_key;
  Key high = origin_key;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f offset = point - origin;
    const double squared =
        static_cast<double>(offset.x() * offset.x() + offset.y() * offset.y() + offset.z() * offset.z());
    Ray ray;
    ray.end = point;
    ray.hits = std::sqrt(squared) <= max_range_;
    if (!ray.hits) {
      ray.end = origin + offset / length_of(offset) * static_cast<float>(max_range_);
    }
    if (!ray.end.allFinite() || !key_of(ray.end, inverse_resolution_, ray.end_key)) {
      continue;
    }
    low = low.cwiseMin(ray.end_key);
    high = high.cwiseMax(ray.end_key);
    rays_.push_back(ray);
  }
  voxels_.box = Box::around(low, high);
  voxels_.rays = rays_.size();
  voxels_.skipped_points = points.size() - rays_.size();
}

void RayCaster::walk(const Ray& ray, const Eigen::Vector3f& origin, const Key& origin_key,
                     std::uint64_t* passed) const {
  if (ray.end_key == origin_key) {
    return;
  }
  const Box& box = voxels_.box;
  Eigen::Vector3f direction = ray.end - origin;
  const float length = length_of(direction);
  direction /= length;
  const Axis x(origin.x(), direction.x(), origin_key.x(), resolution_, 1);
  const Axis y(origin.y(), direction.y(), origin_key.y(), resolution_, box.stride_y());
  const Axis z(origin.z(), direction.z(), origin_key.z(), resolution_, box.stride_z());
  const auto limit = static_cast<double>(length);
  const std::int64_t end = box.place(ray.end_key);
  std::int64_t place = box.place(origin_key);
  double next_x = x.next;
  double next_y = y.next;
  double next_z = z.next;
  do {
    set_bit(passed, place);
    // The axis whose border comes first; ties as in octomap. Selections instead of branches: they do not miss.
    const bool x_first = next_x < next_y && next_x < next_z;
    const bool y_first = !(next_x < next_y) && next_y < next_z;
    const bool z_first = !x_first && !y_first;
    place += x_first ? x.step : (y_first ? y.step : z.step);
    next_x = x_first ? next_x + x.delta : next_x;
    next_y = y_first ? next_y + y.delta : next_y;
    next_z = z_first ? next_z + z.delta : next_z;
  } while (place != end && std::min(std::min(next_x, next_y), next_z) <= limit);
}

const ScanVoxels& RayCaster::cast(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& origin) {
  Key origin_key;
  if (!origin.allFinite() || !key_of(origin, inverse_resolution_, origin_key)) {
    throw InputError("occupancy map", "",
                     "the sensor stands outside the map's " + std::to_string(2 * kMiddle * resolution_) + " m",
                     "use a larger resolution_m");
  }
  make_rays(points, origin, origin_key);
  const auto words = static_cast<std::size_t>(voxels_.box.words());
  voxels_.hit.assign(words, 0);
  for (const Ray& ray : rays_) {
    if (ray.hits) {
      set_bit(voxels_.hit.data(), voxels_.box.place(ray.end_key));
    }
  }
  parts_.resize(std::max<std::size_t>(thread_count(), 1));
  const std::size_t block = (rays_.size() + parts_.size() - 1) / parts_.size();
  parallel_for(parts_.size(), [&](std::size_t part) {
    parts_[part].assign(words, 0);
    for (std::size_t r = part * block; r < std::min(rays_.size(), (part + 1) * block); ++r) {
      walk(rays_[r], origin, origin_key, parts_[part].data());
    }
  });
  voxels_.passed.swap(parts_[0]);
  for (std::size_t part = 1; part < parts_.size(); ++part) {
    std::transform(voxels_.passed.begin(), voxels_.passed.end(), parts_[part].begin(), voxels_.passed.begin(),
                   [](std::uint64_t a, std::uint64_t b) { return a | b; });
  }
  return voxels_;
}

}  // namespace loopmark::occupancy::internal

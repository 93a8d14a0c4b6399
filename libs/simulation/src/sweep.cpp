// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/random.hpp"

namespace loopmark::simulation {
namespace {

constexpr std::size_t kColumnBlock = 32;

/// Distance along a ray to a box that it enters from outside; infinity when it misses (slab test).
double box_distance(const EgoBox& box, const Eigen::Vector3d& direction) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = box.low[axis] / direction[axis];
    const double b = box.high[axis] / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave && enter > 0.0 ? enter : std::numeric_limits<double>::infinity();
}

/// Renders blocks of columns of one sweep.
class Sweeper {
 public:
  Sweeper(const World& world, const World::Moving* moving, const SensorModel& sensor, const SensorMotion& motion,
          Motion frame, std::uint64_t seed)
      : world_(world),
        moving_(moving),
        sensor_(sensor),
        motion_(motion),
        frame_(frame),
        seed_(seed),
        T_stamp_world_(motion(0.0).inverse()),
        column_s_(1.0 / (sensor.rate_hz * sensor.columns)) {}

  PointCloud columns(std::size_t begin, std::size_t end) const {
    std::vector<Shot> shots;
    std::vector<Ray> rays;
    for (std::size_t column = begin; column < end; ++column) {
      aim(column, shots, rays);
    }
    world_.cast(rays, moving_);
    Rng rng(task_seed(seed_, {begin}));
    PointCloud cloud;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      receive(shots[i], rays[i], rng, cloud);
    }
    return cloud;
  }

 private:
  struct Shot {
    Eigen::Vector3d direction;  ///< in the sensor's frame at that moment
    double time_s;
    double ego_m;  ///< range of the car's own body in the way; infinity: none
    std::uint16_t ring;
  };

  double start_s(std::size_t column) const { return static_cast<double>(column) * column_s_ - 0.5 / sensor_.rate_hz; }

  bool blocked(double azimuth) const {
    const double off = std::remainder(azimuth - sensor_.blocked_centre_rad, 2.0 * std::numbers::pi);
    return std::abs(off) < 0.5 * sensor_.blocked_width_rad;
  }

  /// The poses at the start and the end of the column's firings are interpolated for each laser's own moment.
  void aim(std::size_t column, std::vector<Shot>& shots, std::vector<Ray>& rays) const {
    const double begin = start_s(column);
    const Pose here = motion_(begin);
    const Eigen::Vector3d moved = motion_(begin + column_s_).translation() - here.translation();
    for (std::size_t laser = 0; laser < sensor_.elevation_rad.size(); ++laser) {
      const double time = begin + sensor_.fire_offset_s[laser];
      const double azimuth = -2.0 * std::numbers::pi * sensor_.rate_hz * time;
      const double level = std::cos(sensor_.elevation_rad[laser]);
      const Eigen::Vector3d direction(level * std::cos(azimuth), level * std::sin(azimuth),
                                      std::sin(sensor_.elevation_rad[laser]));
      double ego = std::numeric_limits<double>::infinity();
      for (const EgoBox& box : sensor_.ego) {
        ego = std::min(ego, direction.z() < -0.05 ? box_distance(box, direction) : ego);
      }
      if (blocked(azimuth)) {
        ego = 0.6 + 0.05 * static_cast<double>(laser % 3);
      }
      Ray ray;
      const Eigen::Vector3d origin = here.translation() + sensor_.fire_offset_s[laser] / column_s_ * moved;
      ray.origin = origin.cast<float>();
      ray.direction = (here.linear() * direction).cast<float>();
      ray.range_m = static_cast<float>(sensor_.max_range_m + 1.0);
      ray.moment = static_cast<float>(std::clamp(time * sensor_.rate_hz + 0.5, 0.0, 1.0));
      shots.push_back({direction, time, ego, static_cast<std::uint16_t>(laser)});
      rays.push_back(ray);
    }
  }

  void receive(const Shot& shot, const Ray& ray, Rng& rng, PointCloud& cloud) const {
    const double chance = rng.uniform();
    if (std::isfinite(shot.ego_m)) {
      // The car's own body hides what lies behind it and is itself seen now and then.
      if (shot.ego_m > sensor_.min_range_m && chance < 0.3) {
        add(shot, shot.ego_m + sensor_.noise_m * rng.normal(), 0.3, cloud);
      }
      return;
    }
    if (!ray.hit) {
      return;
    }
    const double cosine = std::min(1.0, static_cast<double>(std::abs(ray.normal.dot(ray.direction))));
    const double rho = reflectance(ray.surface, cosine);
    if (chance >= detection_probability(sensor_, rho, cosine, ray.range_m)) {
      return;
    }
    // At grazing incidence the beam's footprint is drawn out along the range.
    const double slant = std::sqrt(1.0 - cosine * cosine) / std::max(cosine, 0.02);
    const double drawn = std::min(0.05, 0.0003 * ray.range_m * slant);
    const double range = ray.range_m + std::hypot(sensor_.noise_m, drawn) * rng.normal();
    const double intensity = rho * (0.35 + 0.65 * cosine) * (1.0 + 0.08 * rng.normal());
    if (range >= sensor_.min_range_m && range <= sensor_.max_range_m) {
      add(shot, range, std::clamp(intensity, 0.0, 1.0), cloud);
    }
  }

  void add(const Shot& shot, double range, double intensity, PointCloud& cloud) const {
    Eigen::Vector3d point = range * shot.direction;
    if (frame_ == Motion::kCompensated) {
      point = T_stamp_world_ * (motion_(shot.time_s) * point);
    }
    cloud.points.push_back(point.cast<float>());
    cloud.intensity.push_back(static_cast<float>(std::round(100.0 * intensity) / 100.0));
    cloud.time_offset_s.push_back(static_cast<float>(shot.time_s));
    cloud.ring.push_back(shot.ring);
  }

  const World& world_;
  const World::Moving* moving_;
  const SensorModel& sensor_;
  const SensorMotion& motion_;
  Motion frame_;
  std::uint64_t seed_;
  Pose T_stamp_world_;
  double column_s_;
};

}  // namespace

PointCloud render_sweep(const World& world, const World::Moving* moving, const SensorModel& sensor,
                        const SensorMotion& motion, Motion frame, std::uint64_t seed) {
  const Sweeper sweeper(world, moving, sensor, motion, frame, seed);
  PointCloud whole;
  return parallel_reduce_ordered(
      static_cast<std::size_t>(sensor.columns), kColumnBlock, whole,
      [&](std::size_t begin, std::size_t end) { return sweeper.columns(begin, end); },
      [](PointCloud& total, const PointCloud& part) {
        total.points.insert(total.points.end(), part.points.begin(), part.points.end());
        total.intensity.insert(total.intensity.end(), part.intensity.begin(), part.intensity.end());
        total.time_offset_s.insert(total.time_offset_s.end(), part.time_offset_s.begin(), part.time_offset_s.end());
        total.ring.insert(total.ring.end(), part.ring.begin(), part.ring.end());
      });
}

Scan render_scan(const World& world, const Drive& drive, std::size_t index, Motion frame) {
  Scan scan;
  scan.index = index;
  scan.stamp_s = drive.stamp_s(index);
  const double half = 0.5 / drive.sensor().rate_hz;
  const auto moving = world.place(drive.traffic().bodies(scan.stamp_s - half, scan.stamp_s + half,
                                                         drive.pose(scan.stamp_s), drive.sensor().max_range_m + 10.0));
  const SensorMotion motion = [&](double offset_s) { return drive.pose(scan.stamp_s + offset_s); };
  scan.cloud =
      render_sweep(world, moving.get(), drive.sensor(), motion, frame,
                   task_seed(drive.options().seed, {60, static_cast<std::uint64_t>(drive.options().day), index}));
  return scan;
}

PointCloud render_standing(const World& world, const World::Moving* moving, const SensorModel& sensor,
                           const Pose& T_world_lidar, std::uint64_t seed) {
  const SensorMotion motion = [&](double) { return T_world_lidar; };
  return render_sweep(world, moving, sensor, motion, Motion::kRaw, seed);
}

}  // namespace loopmark::simulation

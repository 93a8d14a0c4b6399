// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/simulation/drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"
#include "speed_profile.hpp"

namespace loopmark::simulation {
namespace {

double lane_offset(Lane lane) {
  switch (lane) {
    case Lane::kCentre:
      return 0.2;
    case Lane::kLeft:
      return -1.75;
    case Lane::kRight:
    default:
      return 1.75;
  }
}

LanePath cut_to(LanePath path, double length) {
  const auto samples = static_cast<std::size_t>(length / kPathStep) + 2;
  if (path.points.size() > samples) {
    path.points.resize(samples);
    path.heading_rad.resize(samples);
    path.edge.resize(samples);
  }
  return path;
}

/// The route is planned once for all days; driven backwards it covers the same ground.
LanePath plan(const Town& town, const DriveOptions& o) {
  Route route = plan_route(town, o.route, o.length_m);
  if (!o.reverse) {
    return cut_to(make_lane_path(town.roads, route, lane_offset(o.lane)), o.length_m);
  }
  return cut_to(make_lane_path(town.roads, route.reversed(town.roads), lane_offset(o.lane)), o.length_m);
}

/// Small motions of the body on its springs, by the distance driven: heave in metres, pitch and roll in radians.
struct Ripple {
  struct Wave {
    double per_metre, phase;
  };
  std::array<Wave, 4> waves{};

  explicit Ripple(std::uint64_t seed) {
    Rng rng(seed);
    for (Wave& wave : waves) {
      wave = {2.0 * std::numbers::pi / rng.uniform(2.5, 22.0), rng.uniform(0.0, 2.0 * std::numbers::pi)};
    }
  }

  double at(double distance) const {
    double sum = 0.0;
    for (const Wave& wave : waves) {
      sum += std::sin(wave.per_metre * distance + wave.phase);
    }
    return 0.5 * sum;
  }
};

}  // namespace

void check(const DriveOptions& o) {
  require_option(o.length_m >= 10.0 && o.length_m <= 1e6, "length_m", "must lie between 10 and 1000000 metres");
  require_option(o.rate_hz == 0.0 || (o.rate_hz >= 5.0 && o.rate_hz <= 20.0), "rate_hz",
                 "must lie between 5 and 20 Hz, or be 0");
  require_option(o.halt_every_m >= 0.0, "halt_every_m", "must not be negative");
  require_option(o.vehicles >= 0 && o.vehicles <= 5000, "vehicles", "must lie between 0 and 5000");
  require_option(o.pedestrians >= 0 && o.pedestrians <= 5000, "pedestrians", "must lie between 0 and 5000");
}

Pose standing_pose(const Terrain& terrain, const Eigen::Vector2d& p, double yaw_rad, double height_m) {
  const Eigen::Vector2d slope = terrain.road_gradient(p);
  const Eigen::Vector3d up = Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
  const Eigen::Vector3d ahead(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  const Eigen::Vector3d left = up.cross(ahead).normalized();
  Pose pose = Pose::Identity();
  pose.linear().col(0) = left.cross(up);
  pose.linear().col(1) = left;
  pose.linear().col(2) = up;
  pose.translation() = Eigen::Vector3d(p.x(), p.y(), terrain.road(p)) + height_m * up;
  return pose;
}

struct Drive::Impl {
  const Town* town;
  DriveOptions options;
  SensorModel sensor;
  LanePath path;
  internal::SpeedProfile profile;
  Traffic traffic;
  std::vector<Revisit> revisits;
  std::array<Ripple, 3> ripples;
  double first_stamp;
  std::size_t count;

  static internal::SpeedProfile::Limits limits(const DriveOptions& o) {
    Rng rng(task_seed(o.seed, {50}));
    internal::SpeedProfile::Limits limits;
    limits.speed_factor = rng.uniform(0.85, 1.05);
    limits.halt_every_m = o.halt_every_m;
    limits.from_standstill = o.from_standstill;
    return limits;
  }

  Impl(const Town& t, const DriveOptions& o)
      : town(&t),
        options(o),
        sensor(sensor_model(o.sensor)),
        path(plan(t, o)),
        profile(path, t.roads, limits(o), task_seed(o.seed, {51})),
        traffic(t, make_shapes(), {o.vehicles, o.pedestrians},
                task_seed(o.seed, {52, static_cast<std::uint64_t>(o.day)})),
        revisits(find_revisits(path, t.roads)),
        ripples{Ripple(task_seed(o.seed, {53})), Ripple(task_seed(o.seed, {54})), Ripple(task_seed(o.seed, {55}))} {
    if (o.rate_hz > 0.0) {
      sensor = sensor.at_rate(o.rate_hz);
    }
    first_stamp = 0.5 / sensor.rate_hz;
    count = static_cast<std::size_t>(
        std::max(1.0, std::floor((profile.duration_s() - 2.0 * first_stamp) * sensor.rate_hz)));
  }
};

Drive::Drive(const Town& town, const DriveOptions& options) {
  check(options);
  impl_ = std::make_unique<Impl>(town, options);
}
Drive::~Drive() = default;
Drive::Drive(Drive&&) noexcept = default;
Drive& Drive::operator=(Drive&&) noexcept = default;

std::size_t Drive::size() const { return impl_->count; }
double Drive::stamp_s(std::size_t index) const {
  return impl_->first_stamp + static_cast<double>(index) / impl_->sensor.rate_hz;
}
double Drive::distance(double time_s) const { return impl_->profile.distance(time_s); }
double Drive::speed(double time_s) const { return impl_->profile.speed(time_s); }
const SensorModel& Drive::sensor() const { return impl_->sensor; }
const DriveOptions& Drive::options() const { return impl_->options; }
const LanePath& Drive::path() const { return impl_->path; }
const Traffic& Drive::traffic() const { return impl_->traffic; }
const std::vector<Revisit>& Drive::revisits() const { return impl_->revisits; }

Pose Drive::pose(double time_s) const {
  const double s = distance(time_s);
  const double v = speed(time_s);
  const Pose level = standing_pose(impl_->town->terrain, impl_->path.position(s), impl_->path.heading(s), 0.0);
  // On its springs: squats when it accelerates, leans out of bends, shakes on the road's unevenness.
  const double pitch = -0.006 * impl_->profile.acceleration(time_s) + 0.0016 * impl_->ripples[0].at(s);
  const double roll = 0.008 * v * v * impl_->path.curvature(s) + 0.0016 * impl_->ripples[1].at(s);
  Pose body = Pose::Identity();
  body.translate(Eigen::Vector3d(0.0, 0.0, 0.006 * impl_->ripples[2].at(s)));
  body.rotate(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
  body.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  body.translate(Eigen::Vector3d(0.0, 0.0, impl_->sensor.height_m));
  return level * body;
}

std::size_t Drive::scan_at(double distance_m) const {
  std::size_t low = 0;
  std::size_t high = size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    distance(stamp_s(middle)) < distance_m ? low = middle + 1 : high = middle;
  }
  return low;
}

}  // namespace loopmark::simulation

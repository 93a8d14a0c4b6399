// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "loopmark/core/options.hpp"
#include "loopmark/simulation/revisits.hpp"
#include "loopmark/simulation/routes.hpp"
#include "loopmark/simulation/sensor.hpp"
#include "loopmark/simulation/traffic.hpp"

namespace loopmark::simulation {

enum class Lane { kRight, kCentre, kLeft };

struct DriveOptions {
  std::uint64_t seed = 1;  ///< noise, speeds, halts and traffic; not the town and not the route
  int day = 1;             ///< other days, other parked cars and other traffic
  std::string sensor = "hdl64e";
  std::string route = "tour";
  double length_m = 1000.0;
  Lane lane = Lane::kRight;
  bool reverse = false;          ///< drives the route from its end, on its own right-hand side
  double rate_hz = 0.0;          ///< sweeps a second; 0: the sensor's own
  double halt_every_m = 260.0;   ///< mean distance between halts; 0: none
  bool from_standstill = false;  ///< else the log starts while moving
  int vehicles = 26;             ///< moving in the town
  int pedestrians = 45;
};

template <class Visitor>
void describe(Visitor& v, DriveOptions& o) {
  v.field("seed", o.seed, "noise, speeds, halts and traffic; not the town and not the route");
  v.field("day", o.day, "other days, other parked cars and other traffic");
  v.field("sensor", o.sensor, "hdl64e, hdl32e, vlp16 or os1-64");
  v.field("route", o.route, "tour, explore, twins or open");
  v.field("length_m", o.length_m, "driven distance, metres");
  v.choice("lane", o.lane, {{"right", Lane::kRight}, {"centre", Lane::kCentre}, {"left", Lane::kLeft}},
           "lane driven on");
  v.field("reverse", o.reverse, "drive the route from its end");
  v.field("rate_hz", o.rate_hz, "sweeps a second; 0: the sensor's own");
  v.field("halt_every_m", o.halt_every_m, "mean distance between halts, metres; 0: none");
  v.field("from_standstill", o.from_standstill, "start from a halt instead of while moving");
  v.field("vehicles", o.vehicles, "moving vehicles in the town");
  v.field("pedestrians", o.pedestrians, "people walking in the town");
}

/// Throws InputError naming the option when a value makes no sense.
void check(const DriveOptions& options);

/// A drive through a town: where the sensor is at any time. The town must outlive it.
class Drive {
 public:
  Drive(const Town& town, const DriveOptions& options);
  ~Drive();
  Drive(Drive&&) noexcept;
  Drive& operator=(Drive&&) noexcept;

  /// Number of sweeps.
  std::size_t size() const;
  /// Stamp of a sweep: the moment its sensor looks forward, seconds from the start of the drive.
  double stamp_s(std::size_t index) const;
  /// Pose of the sensor in the town at a time, T_world_lidar; x forward, y left, z up.
  Pose pose(double time_s) const;
  /// Metres driven at a time.
  double distance(double time_s) const;
  double speed(double time_s) const;
  const SensorModel& sensor() const;
  const DriveOptions& options() const;
  const LanePath& path() const;
  const Traffic& traffic() const;
  /// The stretches that come back to earlier ones.
  const std::vector<Revisit>& revisits() const;
  /// The first sweep at or after `distance_m` along the path; size() when there is none.
  std::size_t scan_at(double distance_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Pose of a car's sensor standing `height_m` above the street at `p`, heading `yaw`, on the slope there.
Pose standing_pose(const Terrain& terrain, const Eigen::Vector2d& p, double yaw_rad, double height_m);

}  // namespace loopmark::simulation

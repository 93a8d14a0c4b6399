// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"
#include "loopmark/simulation/mesh.hpp"

namespace loopmark::simulation {

/// A part of the car that carries the sensor, in the sensor's frame.
struct EgoBox {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
};

/// A spinning LiDAR. It turns clockwise seen from above, so a column fired `t` seconds after the stamp of its sweep
/// looks to azimuth -2 pi t rate (0 forward, positive to the left): the stamp is the moment it looks forward, the
/// seam is at the rear, and t lies in [-0.5, 0.5) / rate.
struct SensorModel {
  std::string name;
  std::string label;                  ///< as sold
  std::vector<double> elevation_rad;  ///< one a laser, ring 0 the lowest
  std::vector<double> fire_offset_s;  ///< one a laser, after the start of its column
  int columns = 1800;                 ///< columns a sweep at `rate_hz`
  double rate_hz = 10.0;
  double min_range_m = 0.9;
  double max_range_m = 100.0;
  double noise_m = 0.02;            ///< standard deviation of the range on a wall seen squarely
  double reach_10_m = 50.0;         ///< a target of 10 % reflectance is seen half of the time at this range
  double blocked_centre_rad = 0.0;  ///< sector that something on the roof hides: azimuth of its middle
  double blocked_width_rad = 0.0;   ///< its width; 0: none
  double height_m = 1.73;           ///< above the ground
  std::vector<EgoBox> ego;

  std::size_t rays_per_sweep() const { return elevation_rad.size() * static_cast<std::size_t>(columns); }
  /// The same sensor spinning at another rate: its lasers fire as often, so a sweep has more or fewer columns.
  SensorModel at_rate(double hz) const;
};

/// Names that sensor_model() knows: hdl64e, hdl32e, vlp16, os1-64.
std::vector<std::string> sensor_names();

/// Throws InputError for an unknown name. Beam tables: the makers' manuals (HDL-64E S2/S3, HDL-32E, VLP-16; OS1 with
/// even spacing of its 33.2 degrees, as its calibration differs from segment to segment).
SensorModel sensor_model(const std::string& name);

/// Reflectance of a surface for a beam that meets it at the given cosine of incidence, mirror-like share included.
double reflectance(Surface surface, double cos_incidence);

/// Probability that an echo of this reflectance from this range is detected; `cos_incidence` weakens it as a rough
/// surface does.
double detection_probability(const SensorModel& sensor, double reflectance, double cos_incidence, double range_m);

}  // namespace loopmark::simulation

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/simulation/lane_path.hpp"

namespace loopmark::simulation::internal {

/// When a vehicle is where on its path: accelerations bounded, slower in bends, with halts.
class SpeedProfile {
 public:
  struct Limits {
    double accelerate_mps2 = 1.6;
    double brake_mps2 = 2.2;
    double sideways_mps2 = 2.4;
    double speed_factor = 1.0;     ///< of the streets' speed limits
    double halt_every_m = 260.0;   ///< mean distance between halts; 0: none
    bool from_standstill = false;  ///< else the drive starts while moving
  };
  SpeedProfile(const LanePath& path, const RoadNetwork& roads, const Limits& limits, std::uint64_t seed);

  double duration_s() const { return arrive_.back(); }
  /// Distance along the path at a time; before 0 and after the end it goes on at the same speed.
  double distance(double time_s) const;
  double speed(double time_s) const;
  double acceleration(double time_s) const;

 private:
  /// The last sample that was left by then.
  std::size_t sample_at(double time_s) const;

  std::vector<double> speed_;
  std::vector<double> arrive_;  ///< time of arrival at each sample
  std::vector<double> leave_;   ///< later than arrival where it halts
};

}  // namespace loopmark::simulation::internal

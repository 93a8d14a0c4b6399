// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "loopmark/simulation/lane_path.hpp"
#include "loopmark/simulation/world.hpp"

namespace loopmark::simulation {

struct TrafficOptions {
  int vehicles = 26;
  int pedestrians = 45;
};

/// Cars on their rounds through the town and people walking up and down the sidewalks; where each is depends on the
/// seed and the time only.
class Traffic {
 public:
  Traffic(const Town& town, const ShapeList& shapes, const TrafficOptions& options, std::uint64_t seed);

  /// The bodies within `radius` metres of the ego car at `T_world_ego` during [begin_s, end_s], less those that would
  /// touch it.
  std::vector<MovingBody> bodies(double begin_s, double end_s, const Pose& T_world_ego, double radius) const;

 private:
  struct Actor {
    std::size_t shape = 0;
    std::size_t path = 0;
    double start_m = 0.0;
    double speed_mps = 8.0;
    bool to_and_fro = false;  ///< turns round at the ends of its path; else starts over
    double rise_m = 0.0;      ///< above the street's height
  };
  Pose pose(const Actor& actor, double time_s) const;

  const Town* town_;
  std::vector<LanePath> paths_;
  std::vector<Actor> actors_;
};

}  // namespace loopmark::simulation

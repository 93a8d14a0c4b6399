// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Which cuts a drill makes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "loopmark/kidnap_benchmark/drill_options.hpp"
#include "loopmark/kidnap_benchmark/drill_strata.hpp"

namespace loopmark::kidnap_benchmark {

/// What happens while tracking is cut.
enum class Disturbance {
  kOutage,     ///< no scans for a while, the drive goes on
  kTeleport,   ///< the next scan comes from another part of the log
  kTurned,     ///< no scans for a second, then the sensor is turned by an angle
  kOtherDrive  ///< the next scan comes from another drive of the same place
};
const char* name(Disturbance disturbance);

/// One scan that a drill may use.
struct DrillScan {
  std::size_t scan = 0;  ///< place in its log
  double stamp_s = 0.0;
  Pose T_map_lidar = Pose::Identity();  ///< the truth
  Stratum stratum = Stratum::kStraight;
};

struct DrillEvent {
  std::size_t number = 0;
  Disturbance disturbance = Disturbance::kOutage;
  Stratum stratum = Stratum::kStraight;  ///< of the place where it has to be found again
  std::size_t before = 0;                ///< place in the run's scans of the last one before the cut
  std::size_t after = 0;                 ///< and of the first one behind it; of the other drive's scans for kOtherDrive
  double outage_s = 0.0;                 ///< without a scan
  double yaw_deg = 0.0;                  ///< by which the sensor is turned from then on
};

/// Draws the events, evenly over disturbances, strata and lengths of outages as far as the scans have them. The same
/// seed and scans give the same events. `other`: scans of another drive; none: no such events.
/// Throws InputError when the run is too short for a single event.
std::vector<DrillEvent> plan_drill(const std::vector<DrillScan>& run, const std::vector<DrillScan>& other,
                                   const DrillOptions& options);

}  // namespace loopmark::kidnap_benchmark

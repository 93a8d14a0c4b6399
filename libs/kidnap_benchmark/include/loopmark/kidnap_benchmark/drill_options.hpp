// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "loopmark/core/options.hpp"

namespace loopmark::kidnap_benchmark {

/// How tracking is cut in a drill, and what counts as found again.
struct DrillOptions {
  std::size_t events = 40;  ///< cuts
  std::uint64_t seed = 1;   ///< of everything drawn
  /// What is done, by turns; "other-drive" only where there is one.
  std::vector<std::string> disturbances = {"outage", "teleport", "turned", "other-drive"};
  std::vector<double> outages_s = {0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0};  ///< without a scan, by turns
  double teleport_m = 50.0;                                                ///< a teleport is at least so far
  double within_s = 5.0;                                                   ///< found again in time, driving
  double limit_s = 15.0;                                                   ///< then the event ends
  double before_s = 1.0;                                                   ///< tracked before the cut
  double settle_s = 1.0;                                                   ///< a pose found must stay right so long
  double right_m = 0.6;                                                    ///< a pose nearer than this to the truth,
  double right_deg = 5.0;                                                  ///< and turned by less, is right
};

template <class Visitor>
void describe(Visitor& v, DrillOptions& o) {
  v.field("events", o.events, "cuts");
  v.field("seed", o.seed, "seed of everything drawn");
  v.field("disturbances", o.disturbances, "what is done, by turns; other-drive only where there is one");
  v.field("outages_s", o.outages_s, "lengths of the outages, by turns, seconds");
  v.field("teleport_m", o.teleport_m, "a teleport is at least so far, metres");
  v.field("within_s", o.within_s, "found again in time, seconds of driving");
  v.field("limit_s", o.limit_s, "then the event ends, seconds of driving");
  v.field("before_s", o.before_s, "tracked before the cut, seconds");
  v.field("settle_s", o.settle_s, "a pose found must stay right so long, seconds");
  v.field("right_m", o.right_m, "a pose nearer than this to the truth, metres,");
  v.field("right_deg", o.right_deg, "and turned by less, degrees, is right");
}

/// Throws InputError naming the option whose value makes no sense.
void check(const DrillOptions& options);

}  // namespace loopmark::kidnap_benchmark

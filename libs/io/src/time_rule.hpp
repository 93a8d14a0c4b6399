// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the numbers of a cloud message's time field mean, found once for all messages of a topic.
#pragma once

#include <string>
#include <vector>

#include "point_times.hpp"

namespace loopmark::io::internal {

struct TimeRule {
  double unit_s = 0.0;    ///< seconds of one unit; 0: the numbers cannot be times of one sweep
  bool absolute = false;  ///< they count from a clock's zero, not from the stamp or the start of the sweep

  /// "t: nanoseconds since the stamp".
  std::string describe(const std::string& field) const;
};

/// From the least and most time of some sweeps. Absolute times (since 1970 or since the sensor was switched on) are
/// told by their size, the unit of relative ones by their span: of the longest sweep, so that one of few points does
/// not mislead. `fraction`: the numbers can hold fractions; whole numbers are never seconds.
struct TimeSpan {
  double least = 0.0, most = 0.0;
};
TimeRule find_time_rule(const std::vector<TimeSpan>& sweeps, bool fraction);

/// The values by the rule; PointTimes::first_s is set where the rule is absolute.
PointTimes apply_time_rule(const TimeRule& rule, const std::vector<double>& values);

}  // namespace loopmark::io::internal

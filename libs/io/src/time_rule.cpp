// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "time_rule.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::io::internal {
namespace {

constexpr double kLongestSweep_s = 2.0;
constexpr double kShortestSweep_s = 0.002;

/// Seconds of one unit of times since 1970 (after 1973); 0 when they are none.
double unit_since_1970(double time) {
  if (time > 1e17) return 1e-9;
  if (time > 1e14) return 1e-6;
  if (time > 1e11) return 1e-3;
  return time > 1e8 ? 1.0 : 0.0;
}

/// Seconds of one unit of times that span one sweep; 0 when no unit makes a sweep of them.
double unit_of_span(double span, bool fraction) {
  if (fraction && span >= kShortestSweep_s && span <= kLongestSweep_s) return 1.0;
  for (const double unit : {1e-3, 1e-6, 1e-9}) {
    if (span * unit >= kShortestSweep_s && span * unit <= kLongestSweep_s) return unit;
  }
  return 0.0;
}

const char* name_of_unit(double unit_s) {
  if (unit_s == 1.0) return "seconds";
  if (unit_s == 1e-3) return "milliseconds";
  return unit_s == 1e-6 ? "microseconds" : "nanoseconds";
}

}  // namespace

std::string TimeRule::describe(const std::string& field) const {
  if (unit_s == 0.0) {
    return "'" + field + "': its values are no times of one sweep; not used";
  }
  return "'" + field + "', " + name_of_unit(unit_s) + (absolute ? " of a clock" : " from the stamp");
}

TimeRule find_time_rule(const std::vector<TimeSpan>& sweeps, bool fraction) {
  const auto longest = std::max_element(sweeps.begin(), sweeps.end(), [](const TimeSpan& a, const TimeSpan& b) {
    return a.most - a.least < b.most - b.least;
  });
  if (longest == sweeps.end()) {
    return {};
  }
  const double span = longest->most - longest->least;
  const double since_1970 = unit_since_1970(longest->least);
  // Nanoseconds of one sweep (1e8) look like seconds since 1973: such a sweep begins near 0.
  if (since_1970 > 0.0 && span * since_1970 <= kLongestSweep_s && span * since_1970 > 0.0) {
    return {since_1970, true};
  }
  const double unit = unit_of_span(span, fraction);
  const double farthest = std::max(std::abs(longest->least), std::abs(longest->most));
  return {unit, unit > 0.0 && farthest * unit > kLongestSweep_s};
}

PointTimes apply_time_rule(const TimeRule& rule, const std::vector<double>& values) {
  const auto finite = [](double v) { return std::isfinite(v); };
  if (rule.unit_s == 0.0 || values.empty() || !std::all_of(values.begin(), values.end(), finite)) {
    return {};
  }
  PointTimes times;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double origin = rule.absolute ? *least : 0.0;
  if ((*most - *least) * rule.unit_s > kLongestSweep_s) {
    return {};
  }
  times.offset_s.reserve(values.size());
  for (const double value : values) {
    times.offset_s.push_back(static_cast<float>((value - origin) * rule.unit_s));
  }
  if (rule.absolute) {
    times.first_s = origin * rule.unit_s;
  }
  return times;
}

}  // namespace loopmark::io::internal

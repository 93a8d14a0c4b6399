// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_times.hpp"

#include <algorithm>
#include <cmath>

namespace loopmark::io::internal {
namespace {

constexpr double kLongestSweep_s = 2.0;
constexpr double kQuarterHour_s = 900.0;

/// Seconds of one unit of times since 1970; 0 when they are none (before 1973).
double absolute_unit(double first) {
  if (first > 1e17) return 1e-9;
  if (first > 1e14) return 1e-6;
  if (first > 1e11) return 1e-3;
  return first > 1e8 ? 1.0 : 0.0;
}

/// Seconds of one unit of times within one sweep; 0 when no unit makes a sweep of them.
double relative_unit(double span, bool fraction) {
  if (span < 0.002) return 0.0;
  if (fraction && span <= kLongestSweep_s) return 1.0;
  if (span <= 2e3) return 1e-3;
  if (span <= 2e6) return 1e-6;
  return span <= 2e9 ? 1e-9 : 0.0;
}

}  // namespace

PointTimes interpret_times(const std::vector<double>& values, bool fraction) {
  if (values.empty() || !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    return {};
  }
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double first = *least;
  const double span = *most - first;
  const double since_1970 = absolute_unit(first);
  const bool absolute = since_1970 > 0.0 && span * since_1970 <= kLongestSweep_s;
  const double unit = absolute ? since_1970 : relative_unit(span, fraction);
  if (unit == 0.0 || span == 0.0) {
    return {};
  }
  PointTimes times;
  times.offset_s.reserve(values.size());
  const double origin = absolute ? first : 0.0;
  for (const double value : values) {
    times.offset_s.push_back(static_cast<float>((value - origin) * unit));
  }
  if (absolute) {
    times.first_s = first * unit;
  }
  return times;
}

void refer_to_stamp(std::vector<float>& offset_s, double first_time_s, double stamp_s) {
  double shift = first_time_s - stamp_s;
  shift -= kQuarterHour_s * std::round(shift / kQuarterHour_s);
  if (std::abs(shift) > kLongestSweep_s) {
    return;
  }
  for (float& offset : offset_s) {
    offset = static_cast<float>(offset + shift);
  }
}

}  // namespace loopmark::io::internal

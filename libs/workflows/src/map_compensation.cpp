// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Whether and how the scans of a log are deskewed when it is mapped.
#include <algorithm>
#include <cstdio>
#include <optional>

#include "loopmark/workflows/compensation_of_log.hpp"
#include "loopmark/workflows/map_run.hpp"
#include "map_feed.hpp"

namespace loopmark::workflows {
namespace {

constexpr std::size_t kLookedAt = 20;  ///< scans, to find the first that can be read

/// The first scan that can be read; nothing where none of the first ones can.
std::optional<Scan> first_scan(const io::DriveLog& log) {
  for (std::size_t i = 0; i < std::min(log.size(), kLookedAt); ++i) {
    internal::ReadScan read = internal::read_scan(log, i);
    if (read.problem.empty()) {
      return std::move(read.scan);
    }
  }
  return std::nullopt;
}

bool has_times(const Scan& scan) { return scan.cloud.time_offset_s.size() == scan.cloud.size(); }

void require_times(const io::DriveLog& log) {
  const std::optional<Scan> scan = first_scan(log);
  if (scan && !has_times(*scan)) {
    throw InputError(
        log.scan_name(scan->index), "",
        "slam.compensation=raw_given_times wants the time of every point, and this file has none that can be "
        "used (no known field, or the same value for all points, or values that are no times of one sweep)",
        "fields known: t, time, timestamp, time_stamp, offset_time; or take raw_clockwise, "
        "raw_counter_clockwise or measure");
  }
}

/// What a log says that states whether its scans are compensated.
odometry::Compensation stated_by(const io::DriveLog& log) {
  if (*log.info().motion_compensated) {
    return odometry::Compensation::kCompensated;
  }
  const std::optional<Scan> scan = first_scan(log);
  if (scan && has_times(*scan)) {
    return odometry::Compensation::kRawGivenTimes;
  }
  return log.info().sweep && !log.info().sweep->clockwise ? odometry::Compensation::kRawCounterClockwise
                                                          : odometry::Compensation::kRawClockwise;
}

/// What the scans themselves show, as loopmark doctor measures it. Where they do not tell they are left as they are.
LogCompensation measured(const io::DriveLog& log) {
  const odometry::CompensationMeasurement measurement = compensation_of_log(log);
  if (measurement.verdict == odometry::Compensation::kUnknown) {
    return {odometry::Compensation::kCompensated,
            "taken as they are; whether they are compensated " + describe_measurement(measurement)};
  }
  char text[48];
  std::snprintf(text, sizeof text, " (measured, %.0f sigma)", measurement.sigmas);
  return {measurement.verdict, compensation_text(measurement.verdict) + text};
}

}  // namespace

LogCompensation compensation_of(const io::DriveLog& log, const mapping::SlamOptions& options) {
  if (options.compensation != odometry::Compensation::kUnknown) {
    if (options.compensation == odometry::Compensation::kRawGivenTimes) {
      require_times(log);
    }
    return {options.compensation, compensation_text(options.compensation)};
  }
  if (!log.info().motion_compensated) {
    return measured(log);
  }
  const odometry::Compensation stated = stated_by(log);
  return {stated, compensation_text(stated)};
}

std::string compensation_text(odometry::Compensation compensation) {
  switch (compensation) {
    case odometry::Compensation::kCompensated:
      return "compensated already";
    case odometry::Compensation::kRawGivenTimes:
      return "deskewed with the points' times";
    case odometry::Compensation::kRawClockwise:
      return "deskewed, times rebuilt (clockwise)";
    case odometry::Compensation::kRawCounterClockwise:
      return "deskewed, times rebuilt (counter-clockwise)";
    case odometry::Compensation::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace loopmark::workflows

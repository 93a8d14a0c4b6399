// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Whether and how the scans of a log are deskewed when it is mapped.
#include <algorithm>

#include "loopmark/workflows/map_run.hpp"
#include "map_feed.hpp"

namespace loopmark::workflows {
namespace {

/// The first scan that can be read tells whether points have times.
bool points_have_times(const io::DriveLog& log) {
  for (std::size_t i = 0; i < std::min<std::size_t>(log.size(), 20); ++i) {
    const internal::ReadScan read = internal::read_scan(log, i);
    if (read.problem.empty()) {
      return read.scan.cloud.time_offset_s.size() == read.scan.cloud.size();
    }
  }
  return false;
}

}  // namespace

odometry::Compensation compensation_of(const io::DriveLog& log, const mapping::SlamOptions& options) {
  if (options.compensation != odometry::Compensation::kUnknown) {
    return options.compensation;
  }
  if (log.info().motion_compensated.value_or(true)) {
    return odometry::Compensation::kCompensated;
  }
  if (points_have_times(log)) {
    return odometry::Compensation::kRawGivenTimes;
  }
  return log.info().sweep && !log.info().sweep->clockwise ? odometry::Compensation::kRawCounterClockwise
                                                          : odometry::Compensation::kRawClockwise;
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

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Whether and how the scans of a log are deskewed when it is mapped.
#include <algorithm>

#include "map_feed.hpp"
#include "map_run.hpp"

namespace loopmark::app {
namespace {

/// The first scan that can be read tells whether points have times.
bool points_have_times(const DriveLog& log) {
  for (std::size_t i = 0; i < std::min<std::size_t>(log.size(), 20); ++i) {
    const ReadScan read = read_scan(log, i);
    if (read.problem.empty()) {
      return read.scan.cloud.time_offset_s.size() == read.scan.cloud.size();
    }
  }
  return false;
}

}  // namespace

Compensation compensation_of(const DriveLog& log, const SlamOptions& options) {
  if (options.compensation != Compensation::kUnknown) {
    return options.compensation;
  }
  if (log.info().motion_compensated.value_or(true)) {
    return Compensation::kCompensated;
  }
  if (points_have_times(log)) {
    return Compensation::kRawGivenTimes;
  }
  return log.info().sweep && !log.info().sweep->clockwise ? Compensation::kRawCounterClockwise
                                                          : Compensation::kRawClockwise;
}

std::string compensation_text(Compensation compensation) {
  switch (compensation) {
    case Compensation::kCompensated:
      return "compensated already";
    case Compensation::kRawGivenTimes:
      return "deskewed with the points' times";
    case Compensation::kRawClockwise:
      return "deskewed, times rebuilt (clockwise)";
    case Compensation::kRawCounterClockwise:
      return "deskewed, times rebuilt (counter-clockwise)";
    case Compensation::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace loopmark::app

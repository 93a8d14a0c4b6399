// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_feed.hpp"

#include <sys/resource.h>

#include <cstdio>
#include <future>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/core/progress.hpp"

namespace loopmark::workflows::internal {
namespace {

constexpr double kCheckpointEvery_s = 30.0;  // of work: what a kill costs at most

std::string progress_note(const mapping::Mapper& mapper, double seconds, double first_stamp_s) {
  const double driven_s = mapper.scans().back().stamp_s - first_stamp_s;
  return format_text("%.1f x real time, %zu keyframes, %s", seconds > 0.0 ? driven_s / seconds : 0.0,
                     mapper.keyframes().size(), memory_text().c_str());
}

/// Why a scan that could be read cannot be mapped; empty where it can.
std::string problem_of(const io::DriveLog& log, const ReadScan& read, odometry::Compensation compensation) {
  const PointCloud& cloud = read.scan.cloud;
  const bool lacks_times =
      compensation == odometry::Compensation::kRawGivenTimes && cloud.time_offset_s.size() != cloud.size();
  return lacks_times ? log.scan_name(read.scan.index) + ": its points have no times that can be used" : "";
}

void store_result(mapping::Mapper& mapper, const io::DriveLog& log, std::size_t index, const ReadScan& read,
                  bool copy) {
  const std::string problem = read.problem.empty() ? problem_of(log, read, mapper.compensation()) : read.problem;
  if (!problem.empty()) {
    mapper.add_damaged(index, log.stamp_s(index), problem);
    return;
  }
  if (copy) {
    mapper.add_copy(index, log.stamp_s(index));
    return;
  }
  try {
    mapper.add(read.scan);
  } catch (const io::DamagedScan& damage) {
    mapper.add_damaged(index, log.stamp_s(index), log.scan_name(index) + ": " + damage.what());
  }
}

}  // namespace

ReadScan read_scan(const io::DriveLog& log, std::size_t index) {
  try {
    return {log.read(index), "", ""};
  } catch (const io::DamagedScan& damage) {
    return {{}, damage.what(), ""};
  }
}

std::string memory_text() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::to_string(usage.ru_maxrss / 1024) + " MB";
}

namespace {

/// The points of the last scan that a resumed mapper has: the next one may be a copy of it.
std::vector<Eigen::Vector3f> points_before(const io::DriveLog& log, const std::vector<map_store::ScanRecord>& scans) {
  for (std::size_t i = scans.size(); i > 0; --i) {
    const ReadScan read = read_scan(log, i - 1);
    if (read.problem.empty()) {
      return read.scan.cloud.points;
    }
  }
  return {};
}

}  // namespace

void feed(mapping::Mapper& mapper, const io::DriveLog& log, InputRecord& inputs, MapTimes& times) {
  Progress progress("odometry", "scans", log.size());
  progress.add(mapper.scans().size());
  inputs.verify(mapper.scans().size());
  const auto save = [&] {
    inputs.sync();
    mapper.checkpoint();
  };
  const Stopwatch watch;
  Stopwatch since_saved;
  std::future<ReadScan> next;
  const auto read = [&log, &inputs](std::size_t index) {
    ReadScan result = read_scan(log, index);
    result.input = inputs.of_scan(index);
    return result;
  };
  std::vector<Eigen::Vector3f> last = points_before(log, mapper.scans());
  for (std::size_t index = mapper.scans().size(); index < log.size(); ++index) {
    Stopwatch part;
    const ReadScan now = next.valid() ? next.get() : read(index);
    if (index + 1 < log.size()) {
      next = std::async(std::launch::async, read, index + 1);
    }
    times.reading += part.seconds();
    part.reset();
    inputs.keep(now.input);
    const bool copy = now.problem.empty() && !last.empty() && now.scan.cloud.points == last;
    store_result(mapper, log, index, now, copy);
    if (now.problem.empty()) {
      last = now.scan.cloud.points;
    }
    times.odometry += part.seconds();
    progress.add(1, progress_note(mapper, watch.seconds(), mapper.scans().front().stamp_s));
    if (interrupt_requested()) {
      save();
      check_interrupt();
    }
    if (since_saved.seconds() > kCheckpointEvery_s) {
      save();
      since_saved.reset();
    }
  }
  mapper.end_log();
  save();
}

}  // namespace loopmark::workflows::internal

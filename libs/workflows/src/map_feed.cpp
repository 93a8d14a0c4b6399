// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_feed.hpp"

#include <sys/resource.h>

#include <cstdio>
#include <future>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"

namespace loopmark::workflows::internal {
namespace {

constexpr std::size_t kCheckpointEvery = 500;  // scans

std::string progress_note(const mapping::Mapper& mapper, double seconds, double first_stamp_s) {
  char text[96];
  const double driven_s = mapper.scans().back().stamp_s - first_stamp_s;
  std::snprintf(text, sizeof text, "%.1f x real time, %zu keyframes, %s", seconds > 0.0 ? driven_s / seconds : 0.0,
                mapper.keyframes().size(), memory_text().c_str());
  return text;
}

void store_result(mapping::Mapper& mapper, const io::DriveLog& log, std::size_t index, const ReadScan& read) {
  if (!read.problem.empty()) {
    mapper.add_damaged(index, log.stamp_s(index), read.problem);
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

void feed(mapping::Mapper& mapper, const io::DriveLog& log, InputRecord& inputs, MapTimes& times) {
  Progress progress("scans", log.size());
  progress.add(mapper.scans().size());
  const Stopwatch watch;
  std::future<ReadScan> next;
  const auto read = [&log, &inputs](std::size_t index) {
    ReadScan result = read_scan(log, index);
    result.input = inputs.of_scan(index);
    return result;
  };
  for (std::size_t index = mapper.scans().size(); index < log.size(); ++index) {
    Stopwatch part;
    const ReadScan now = next.valid() ? next.get() : read(index);
    if (index + 1 < log.size()) {
      next = std::async(std::launch::async, read, index + 1);
    }
    times.reading += part.seconds();
    part.reset();
    inputs.keep(now.input);
    store_result(mapper, log, index, now);
    times.odometry += part.seconds();
    progress.add(1, progress_note(mapper, watch.seconds(), mapper.scans().front().stamp_s));
    if (interrupt_requested()) {
      mapper.checkpoint();
      check_interrupt();
    }
    if ((index + 1) % kCheckpointEvery == 0) {
      mapper.checkpoint();
    }
  }
  mapper.end_log();
  mapper.checkpoint();
}

}  // namespace loopmark::workflows::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/io/log_report.hpp"

#include <algorithm>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::io {
namespace {

/// What reading one scan showed.
struct ScanFacts {
  std::string problem;
  std::size_t points = 0;
  DroppedPoints dropped;
  PointTimeSource times = PointTimeSource::kMissing;
  double first_s = 0.0, last_s = 0.0;
  bool intensity = false;
  bool ring = false;
  bool viewpoint = false;
  std::uint32_t checksum = 0;
};

std::uint32_t checksum_of(const PointCloud& cloud) {
  return storage::crc32({reinterpret_cast<const char*>(cloud.points.data()), cloud.size() * sizeof(Eigen::Vector3f)});
}

ScanFacts facts_of(const DriveLog& log, std::size_t index) {
  ScanFacts facts;
  try {
    const ScanReading reading = log.read_closely(index);
    const PointCloud& cloud = reading.scan.cloud;
    facts.points = cloud.size();
    facts.dropped = reading.dropped;
    facts.intensity = !cloud.intensity.empty();
    facts.ring = !cloud.ring.empty();
    facts.viewpoint = reading.has_viewpoint;
    facts.checksum = checksum_of(cloud);
    if (!cloud.time_offset_s.empty()) {
      facts.times = reading.times_rebuilt ? PointTimeSource::kRebuilt : PointTimeSource::kInFiles;
      const auto [first, last] = std::minmax_element(cloud.time_offset_s.begin(), cloud.time_offset_s.end());
      facts.first_s = static_cast<double>(*first);
      facts.last_s = static_cast<double>(*last);
    }
  } catch (const InputError& error) {
    facts.problem = error.what();
  }
  return facts;
}

double median_of(std::vector<double> values) {
  if (values.empty()) {
    return 0.0;
  }
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void add_usable(LogReport& report, const ScanFacts& facts) {
  report.point_times = report.usable == 0 || report.point_times == facts.times ? facts.times : PointTimeSource::kMixed;
  report.has_intensity = facts.intensity && (report.usable == 0 || report.has_intensity);
  report.has_ring = facts.ring && (report.usable == 0 || report.has_ring);
  report.dropped.not_finite += facts.dropped.not_finite;
  report.dropped.absurd += facts.dropped.absurd;
  report.dropped.no_return += facts.dropped.no_return;
  report.viewpoints += facts.viewpoint ? 1 : 0;
  ++report.usable;
}

void sum_up(LogReport& report, const std::vector<ScanFacts>& all) {
  std::vector<double> points, first, last;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].problem.empty()) {
      report.damaged.push_back({i, all[i].problem});
      continue;
    }
    add_usable(report, all[i]);
    points.push_back(static_cast<double>(all[i].points));
    first.push_back(all[i].first_s);
    last.push_back(all[i].last_s);
    if (i > 0 && all[i].points == all[i - 1].points && all[i].checksum == all[i - 1].checksum) {
      report.copies.push_back(i);
    }
  }
  if (!points.empty()) {
    const auto [least, most] = std::minmax_element(points.begin(), points.end());
    report.points_least = static_cast<std::size_t>(*least);
    report.points_most = static_cast<std::size_t>(*most);
    report.points_median = static_cast<std::size_t>(median_of(points));
    report.sweep_first_s = median_of(first);
    report.sweep_last_s = median_of(last);
  }
}

double path_length(const std::vector<Pose>& poses) {
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return length;
}

/// The sensor as a usable scan in the middle of the log shows it.
SensorGuess sensor_of(const DriveLog& log, const std::vector<ScanFacts>& all) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::size_t i = (all.size() / 2 + k) % all.size();
    if (all[i].problem.empty()) {
      return guess_sensor(log.read(i).cloud);
    }
  }
  return {};
}

}  // namespace

LogReport examine_log(const DriveLog& log) {
  constexpr std::size_t kBlock = 32;  // between looks at the user's wish to stop
  std::vector<ScanFacts> all(log.size());
  Progress progress("reading", "scans", log.size());
  for (std::size_t begin = 0; begin < log.size(); begin += kBlock) {
    check_interrupt();
    const std::size_t count = std::min(kBlock, log.size() - begin);
    parallel_for(count, [&](std::size_t i) { all[begin + i] = facts_of(log, begin + i); });
    progress.add(count);
  }
  progress.finish();
  LogReport report;
  report.info = log.info();
  if (const RecordedLog* recorded = as_recorded(log)) {
    report.recording = recorded->recording();
  }
  report.scans = log.size();
  sum_up(report, all);
  std::vector<double> stamps;
  for (std::size_t i = 0; i < log.size(); ++i) {
    stamps.push_back(log.stamp_s(i));
  }
  report.stamps = examine_stamps(stamps);
  report.sensor = sensor_of(log, all);
  report.truth_length_m = path_length(log.truth());
  return report;
}

DatasetReport examine_dataset(const Dataset& dataset) {
  DatasetReport report{dataset.layout(), dataset.describe(), dataset.root(), {}};
  Progress progress("reading", "drives", dataset.sessions().size());
  for (const SessionInfo& info : dataset.sessions()) {
    check_interrupt();
    SessionReport session;
    session.session = info;
    try {
      const DriveLog& log = dataset.log(info.number);
      session.scans = log.size();
      session.first_frame = log.frame_number(0);
      session.last_frame = log.frame_number(log.size() - 1);
      session.truth_given = log.info().truth_given;
      session.points = log.read(0).cloud.size();
    } catch (const InputError& error) {
      session.problem = error.what();
    }
    report.sessions.push_back(std::move(session));
    progress.add();
  }
  return report;
}

}  // namespace loopmark::io

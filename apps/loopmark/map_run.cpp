// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_run.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <future>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/slam/engine_registrar.hpp"
#include "loopmark/slam/products.hpp"
#include "map_manifest.hpp"

namespace loopmark::app {
namespace {

constexpr std::size_t kCheckpointEvery = 500;  // scans

/// A scan, or why there is none.
struct Read {
  Scan scan;
  std::string problem;
  std::string input;  ///< for the record of the inputs
};

Read read_scan(const DriveLog& log, std::size_t index) {
  try {
    return {log.read(index), "", ""};
  } catch (const DamagedScan& damage) {
    return {{}, damage.what(), ""};
  }
}

std::string memory_text() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::to_string(usage.ru_maxrss / 1024) + " MB";
}

std::string progress_note(const Mapper& mapper, double seconds, double first_stamp_s) {
  char text[96];
  const double driven_s = mapper.scans().back().stamp_s - first_stamp_s;
  std::snprintf(text, sizeof text, "%.1f x real time, %zu keyframes, %s", seconds > 0.0 ? driven_s / seconds : 0.0,
                mapper.keyframes().size(), memory_text().c_str());
  return text;
}

void take_in(Mapper& mapper, const DriveLog& log, std::size_t index, const Read& read) {
  if (!read.problem.empty()) {
    mapper.add_damaged(index, log.stamp_s(index), read.problem);
    return;
  }
  try {
    mapper.add(read.scan);
  } catch (const DamagedScan& damage) {
    mapper.add_damaged(index, log.stamp_s(index), log.scan_name(index) + ": " + damage.what());
  }
}

/// Every scan of the log goes through the mapper; the next one is read meanwhile.
void feed(Mapper& mapper, const DriveLog& log, InputRecord& inputs, MapTimes& times) {
  Progress progress("scans", log.size());
  progress.add(mapper.scans().size());
  const Stopwatch watch;
  std::future<Read> next;
  const auto read = [&log, &inputs](std::size_t index) {
    Read result = read_scan(log, index);
    result.input = inputs.of_scan(index);
    return result;
  };
  for (std::size_t index = mapper.scans().size(); index < log.size(); ++index) {
    Stopwatch part;
    const Read now = next.valid() ? next.get() : read(index);
    if (index + 1 < log.size()) {
      next = std::async(std::launch::async, read, index + 1);
    }
    times.reading += part.seconds();
    part.reset();
    inputs.keep(now.input);
    take_in(mapper, log, index, now);
    times.odometry += part.seconds();
    progress.add(1, progress_note(mapper, watch.seconds(), mapper.scans().front().stamp_s));
    if (interrupt_requested()) {
      mapper.checkpoint();
      check_interrupt();
    }
    if ((index + 1) % kCheckpointEvery == 0 || index + 1 == log.size()) {
      mapper.checkpoint();
    }
  }
}

void close_loops(Mapper& mapper, MapTimes& times) {
  const Stopwatch watch;
  LoopProgress progress;
  mapper.close_loops([&](std::size_t done, std::size_t total) { progress.show(done, total); });
  times.loops = watch.seconds();
}

std::string name(Compensation compensation) {
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

/// The first scan that can be read tells whether points have times.
bool points_have_times(const DriveLog& log) {
  for (std::size_t i = 0; i < std::min<std::size_t>(log.size(), 20); ++i) {
    const Read read = read_scan(log, i);
    if (read.problem.empty()) {
      return read.scan.cloud.time_offset_s.size() == read.scan.cloud.size();
    }
  }
  return false;
}

std::vector<Pose> truth_of(const DriveLog& log, const std::filesystem::path& file) {
  std::vector<Pose> truth = log.truth();
  if (!file.empty()) {
    truth = read_trajectory(file).poses;
  }
  if (!truth.empty() && truth.size() != log.size()) {
    throw InputError(file.string(), "",
                     std::to_string(truth.size()) + " poses for " + std::to_string(log.size()) + " scans",
                     "the truth must have one pose for each scan");
  }
  return truth;
}

/// What a run is judged by stays with it, so that it can be judged again without the log.
void keep_truth(const RunFolder& folder, const DriveLog& log, const std::vector<Pose>& truth) {
  std::vector<double> stamps_s;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    stamps_s.push_back(log.stamp_s(i));
  }
  if (!truth.empty()) {
    write_tum(truth_file(folder), stamps_s, truth);
  }
}

/// Compares the scans that have a place in the map with the truth, where that is known.
void judge(const std::vector<ScanRecord>& scans, const SolvedMap& map, const std::vector<Pose>& truth,
           MapSummary& summary) {
  std::vector<Pose> solved;
  std::vector<Pose> odometry;
  std::vector<Pose> true_poses;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (map.component[i] == 0) {
      solved.push_back(map.T_map_scan[i]);
      odometry.push_back(scans[i].T_piece_lidar);
      true_poses.push_back(truth[i]);
    }
  }
  if (!true_poses.empty()) {
    summary.absolute = absolute_error(solved, true_poses);
    summary.absolute_odometry = absolute_error(odometry, true_poses);
    summary.kitti = kitti_error(solved, true_poses);
  }
}

}  // namespace

void LoopProgress::show(std::size_t done, std::size_t total) {
  if (total_ != total) {
    progress_ = std::make_unique<Progress>("loop candidates", total);
    progress_->add(shown_);
    total_ = total;
  }
  progress_->add(done - shown_, memory_text());
  shown_ = done;
}

void write_maps(const RunFolder& folder, const std::vector<ScanRecord>& scans, const std::vector<LoopRecord>& loops,
                const SolvedMap& map, const AppOptions& options) {
  write_trajectory_products(folder, scans, loops, map);
  write_occupancy(folder, map, options.occupancy);
  write_clouds(folder, map, options.slam.cloud_voxel_m);
  write_mrpt_products(folder, scans, loops, map);
}

MapSummary summarize(const std::vector<ScanRecord>& scans, const std::vector<LoopRecord>& loops, const SolvedMap& map,
                     const std::vector<Pose>& truth) {
  MapSummary s;
  s.scans = scans.size();
  for (const ScanRecord& scan : scans) {
    s.recovered += scan.state == ScanState::kRecovered ? 1 : 0;
    if (scan.state == ScanState::kDamaged) {
      ++s.damaged;
      s.damage.push_back(scan.problem);
    }
  }
  s.keyframes = map.keyframes.size();
  s.candidates = map.loops.size();
  s.loops = static_cast<std::size_t>(
      std::count_if(map.loops.begin(), map.loops.end(), [](const LoopVerdict& loop) { return loop.accepted; }));
  s.components = map_components(scans, loops, map);
  s.path_m = map.keyframes.back().path_m;
  s.duration_s = scans.back().stamp_s - scans.front().stamp_s;
  judge(scans, map, truth, s);
  return s;
}

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

namespace {

MapOutcome map_into(RunFolder& folder, const MapJob& job, const AppOptions& options, const std::string& started) {
  const Stopwatch whole;
  MapOutcome outcome;
  MapTimes& times = outcome.times;
  const std::unique_ptr<DriveLog> log = open_log(job.log, options.log);
  const std::vector<Pose> truth = truth_of(*log, job.truth);
  keep_truth(folder, *log, truth);
  const Compensation compensation = compensation_of(*log, options.slam);

  InputRecord inputs(folder, *log);
  Mapper mapper(folder, {options.odometry, options.slam, options.pose_graph}, engine_registrar(options.registration),
                compensation, log->info().sweep.value_or(SweepModel{}));
  feed(mapper, *log, inputs, times);
  if (mapper.keyframes().empty()) {
    throw InputError(job.log.string(), "", "no scan could be used");
  }
  close_loops(mapper, times);
  Stopwatch part;
  const SolvedMap map = mapper.solve();
  times.solving = part.seconds();

  part.reset();
  write_maps(folder, mapper.scans(), mapper.loops(), map, options);
  times.products = part.seconds();
  outcome.summary = summarize(mapper.scans(), mapper.loops(), map, truth);
  outcome.summary.compensation = name(compensation);
  times.whole = whole.seconds();
  write_map_report(folder, mapper.scans(), mapper.loops(), map, outcome.summary, times, truth);
  write_summary(folder, outcome.summary, times);
  write_manifest(folder, manifest_of_map(job, started, times.whole, inputs.finish()));
  folder.finish();
  return outcome;
}

}  // namespace

MapOutcome run_map(RunFolder folder, const MapJob& job, const AppOptions& options) {
  const Stopwatch whole;
  const std::string started = utc_now();
  try {
    return map_into(folder, job, options, started);
  } catch (const std::exception& problem) {
    leave_manifest(folder, manifest_of_map(job, started, whole.seconds()), problem);
    throw;
  }
}

}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/map_run.hpp"

#include <ctime>

#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/workflows/compensation_of_log.hpp"
#include "map_feed.hpp"
#include "map_manifest.hpp"
#include "pair_registration.hpp"

namespace loopmark::workflows {
namespace {

void close_loops(mapping::Mapper& mapper, MapTimes& times) {
  const Stopwatch watch;
  LoopProgress progress;
  mapper.close_loops([&](std::size_t done, std::size_t total) { progress.show(done, total); });
  times.loops = watch.seconds();
}

std::vector<double> stamps_of(const io::DriveLog& log) {
  std::vector<double> stamps_s;
  for (std::size_t i = 0; i < log.size(); ++i) {
    stamps_s.push_back(log.stamp_s(i));
  }
  return stamps_s;
}

std::vector<Pose> truth_of(const io::DriveLog& log, const std::filesystem::path& file) {
  return file.empty() ? log.truth() : io::poses_of_scans(io::read_trajectory(file), stamps_of(log), file.string());
}

/// What a run is judged by stays with it, so that it can be judged again without the log.
void keep_truth(const map_store::RunFolder& folder, const io::DriveLog& log, const std::vector<Pose>& truth) {
  if (!truth.empty()) {
    io::write_tum(truth_file(folder), stamps_of(log), truth);
  }
}

/// Registered clouds would come out as a drive of 0 m.
void refuse_world_frame(const io::DriveLog& log) {
  const std::string problem = frame_problem_of_log(log);
  if (!problem.empty()) {
    throw InputError(log.info().path.string(), "", problem,
                     "give the scans as the sensor took them, each in its own frame: undo the poses that were applied");
  }
}

MapOutcome map_into(map_store::RunFolder& folder, const MapJob& job, const ProgramOptions& options,
                    const std::string& started) {
  const Stopwatch whole;
  MapOutcome outcome;
  MapTimes& times = outcome.times;
  const std::unique_ptr<io::DriveLog> log = io::open_log(job.log, options.log);
  const std::vector<Pose> truth = truth_of(*log, job.truth);
  keep_truth(folder, *log, truth);
  refuse_world_frame(*log);
  const LogCompensation compensation = compensation_of(*log, options.slam);

  internal::InputRecord inputs(folder, *log);
  mapping::Mapper mapper(folder, {options.odometry, options.slam, options.pose_graph},
                         internal::pair_registration_of(options), compensation.used,
                         log->info().sweep.value_or(cloud::SweepModel{}));
  internal::feed(mapper, *log, inputs, times);
  if (mapper.keyframes().empty()) {
    throw InputError(job.log.string(), "", "no scan could be used; the last: " + mapper.scans().back().problem);
  }
  close_loops(mapper, times);
  Stopwatch part;
  check_interrupt();
  const mapping::SolvedMap map = mapper.solve();
  times.solving = part.seconds();

  part.reset();
  write_maps(folder, mapper.scans(), mapper.loops(), map, options);
  times.products = part.seconds();
  const Progress progress("report and manifest");
  outcome.summary = summarize(mapper.scans(), mapper.loops(), map, truth);
  outcome.summary.compensation = compensation.text;
  if (!log->info().problem.empty()) {
    outcome.summary.doubts.push_back({log->info().problem, {}});
  }
  times.whole = whole.seconds();
  write_map_report(folder, mapper.scans(), mapper.loops(), map, outcome.summary, times, truth, options.slam.min_loop_p);
  write_summary(folder, outcome.summary, times);
  map_export::write_manifest(folder, internal::manifest_of_map(job, started, times.whole, inputs.finish()));
  folder.finish();
  return outcome;
}

}  // namespace

void LoopProgress::show(std::size_t done, std::size_t total) {
  if (total_ != total) {
    progress_ = std::make_unique<Progress>("loops", "candidates", total);
    progress_->add(shown_);
    total_ = total;
  }
  progress_->add(done - shown_, internal::memory_text());
  shown_ = done;
}

void write_maps(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map,
                const ProgramOptions& options) {
  check_interrupt();
  map_export::write_trajectory_products(folder, scans, loops, map);
  check_interrupt();
  map_export::write_occupancy(folder, map, options.occupancy);
  check_interrupt();
  map_export::write_clouds(folder, map, options.slam.cloud_voxel_m);
  check_interrupt();
  map_export::write_mrpt_products(folder, scans, loops, map);
  check_interrupt();
}

MapOutcome run_map(map_store::RunFolder folder, const MapJob& job, const ProgramOptions& options) {
  const Stopwatch whole;
  const std::string started = utc_now();
  try {
    return map_into(folder, job, options, started);
  } catch (const std::exception& problem) {
    internal::leave_manifest(folder, internal::manifest_of_map(job, started, whole.seconds()), problem);
    throw;
  }
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace loopmark::workflows

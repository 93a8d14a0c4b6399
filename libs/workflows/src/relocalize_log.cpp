// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/relocalize_log.hpp"

#include <memory>
#include <optional>

#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/localization/run_place_map.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/workflows/compensation_of_log.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows {
namespace {

std::vector<localization::RelocalizedScan> place_scans(const RelocalizeJob& job, const ProgramOptions& options,
                                                       const io::DriveLog& log) {
  const map_store::RunFolder run = map_store::RunFolder::open(job.run);
  const ProgramOptions made_with = config::load<ProgramOptions>(run / "config.yaml", {});
  const map_store::RunRecords records = map_store::read_run_records(run);
  const mapping::SolvedMap solved =
      mapping::solve_map(records.scans, records.loops, made_with.slam, made_with.pose_graph, records.decisions);
  Progress reading("reading the map");
  const auto map = localization::open_place_map(run, solved, options.relocalization, options.registration);
  reading.finish();
  const odometry::Compensation compensation = compensation_of(log, options.slam).used;
  const auto new_relocalizer = [&] {
    return std::make_unique<localization::Relocalizer>(map, options.relocalization, options.odometry, compensation,
                                                       log.info().sweep.value_or(cloud::SweepModel{}));
  };
  std::unique_ptr<localization::Relocalizer> relocalizer = new_relocalizer();
  std::vector<localization::RelocalizedScan> placed;
  Progress progress("relocalization", "scans", (log.size() + job.every - 1) / job.every);
  for (std::size_t i = 0; i < log.size(); i += job.every) {
    check_interrupt();
    if (job.single) {
      relocalizer = new_relocalizer();
    }
    try {
      placed.push_back(relocalizer->add(log.read(i)));
    } catch (const io::DamagedScan& damage) {
      localization::RelocalizedScan none;
      none.scan = i;
      none.stamp_s = log.stamp_s(i);
      none.reason = damage.what();
      placed.push_back(none);
    }
    progress.add(1, name(placed.back().state));
  }
  return placed;
}

/// What answers are judged by.
struct Truth {
  mapping::MapTruth map;
  std::vector<Pose> query;
};

std::optional<Truth> read_truth(const RelocalizeJob& job, const io::DriveLog& log) {
  if (job.map_truth.empty()) {
    return std::nullopt;
  }
  std::vector<double> stamps_s;
  for (std::size_t i = 0; i < log.size(); ++i) {
    stamps_s.push_back(log.stamp_s(i));
  }
  std::vector<Pose> query = job.truth.empty()
                                ? log.truth()
                                : io::poses_of_scans(io::read_trajectory(job.truth), stamps_s, job.truth.string());
  const io::Trajectory run = io::read_trajectory(job.run / "trajectory.tum");
  const std::vector<Pose>& map = run.poses;
  const std::vector<Pose> true_map =
      io::poses_of_scans(io::read_trajectory(job.map_truth), run.stamps_s, job.map_truth.string());
  if (query.size() != log.size()) {
    throw InputError((job.truth.empty() ? job.log : job.truth).string(), "",
                     std::to_string(query.size()) + " true poses for " + std::to_string(log.size()) + " scans",
                     "see --truth");
  }
  return Truth{mapping::MapTruth(map, true_map), std::move(query)};
}

}  // namespace

RelocalizeOutcome relocalize_log(const RelocalizeJob& job, const ProgramOptions& options) {
  const std::unique_ptr<io::DriveLog> log = io::open_log(job.log, options.log);
  map_store::RunFolder::open(job.run);
  const std::optional<Truth> truth = read_truth(job, *log);
  const Stopwatch watch;
  RelocalizeOutcome outcome;
  outcome.scans = place_scans(job, options, *log);
  outcome.summary = localization::summarize(outcome.scans);
  outcome.summary.seconds = watch.seconds();
  if (truth) {
    localization::judge(outcome.scans, truth->map, truth->query, outcome.summary);
    outcome.map_truth = truth->map;
    outcome.true_query = truth->query;
  }
  return outcome;
}

}  // namespace loopmark::workflows

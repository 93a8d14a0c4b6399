// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/localization/relocalization_report.hpp"
#include "loopmark/localization/run_place_map.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::app {
namespace {

struct RelocalizeArguments {
  std::filesystem::path run;
  std::filesystem::path log;
  std::filesystem::path output;
  std::filesystem::path map_truth;
  std::filesystem::path truth;
  std::size_t every = 1;
  bool single = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark relocalize runs/day1 drives/day2 -o where            every scan of day2, tracked once found
  loopmark relocalize runs/day1 drives/day2 -o where --single   each scan on its own, as after a crash
  loopmark relocalize runs/day1 drives/day2 -o where --every 10 --map-truth drives/day1/poses.txt
The output folder holds relocalization.csv (state, P(correct), pose and covariance of each scan), trajectory.tum (the
scans that were placed) and summary.json (time to the first pose, losses, recoveries). With the true poses of the run's
scans, and of the log's in the same world, answers are judged.)";

void declare(CLI::App& command, RelocalizeArguments& a) {
  command.add_option("RUN", a.run, "map: a run folder of loopmark map")->required();
  command.add_option("LOG", a.log, "drive log to place in it")->required();
  command.add_option("-o,--output", a.output, "folder to make; must not exist")->required();
  command.add_option("--every", a.every, "take every n-th scan")->check(CLI::PositiveNumber);
  command.add_flag("--single", a.single, "place each scan on its own, without the scans before it");
  command.add_option("--map-truth", a.map_truth, "true poses of the run's scans (TUM or KITTI)");
  command.add_option("--truth", a.truth, "true poses of the log's scans; else those that lie beside it");
  command.footer(kExamples);
}

std::vector<localization::RelocalizedScan> place_scans(const RelocalizeArguments& a,
                                                       const workflows::ProgramOptions& options,
                                                       const io::DriveLog& log) {
  const map_store::RunFolder run = map_store::RunFolder::open(a.run);
  const workflows::ProgramOptions made_with = config::load<workflows::ProgramOptions>(run / "config.yaml", {});
  const mapping::SolvedMap solved =
      mapping::solve_map(map_store::read_scan_records(run), map_store::read_loop_records(run), made_with.slam,
                         made_with.pose_graph, map_store::read_loop_decisions(run));
  const auto map = localization::open_place_map(run, solved, options.relocalization, options.registration);
  const odometry::Compensation compensation = workflows::compensation_of(log, options.slam);
  const auto new_relocalizer = [&] {
    return std::make_unique<localization::Relocalizer>(map, options.relocalization, options.odometry, compensation,
                                                       log.info().sweep.value_or(cloud::SweepModel{}));
  };
  std::unique_ptr<localization::Relocalizer> relocalizer = new_relocalizer();
  std::vector<localization::RelocalizedScan> placed;
  Progress progress("scans", (log.size() + a.every - 1) / a.every);
  for (std::size_t i = 0; i < log.size(); i += a.every) {
    check_interrupt();
    if (a.single) {
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

std::optional<Truth> read_truth(const RelocalizeArguments& a, const io::DriveLog& log) {
  if (a.map_truth.empty()) {
    return std::nullopt;
  }
  std::vector<Pose> query = a.truth.empty() ? log.truth() : io::read_trajectory(a.truth).poses;
  const std::vector<Pose> map = io::read_trajectory(a.run / "trajectory.tum").poses;
  const std::vector<Pose> true_map = io::read_trajectory(a.map_truth).poses;
  if (map.size() != true_map.size()) {
    throw InputError(
        a.map_truth.string(), "",
        std::to_string(true_map.size()) + " poses for " + std::to_string(map.size()) + " scans of the run");
  }
  if (query.size() != log.size()) {
    throw InputError((a.truth.empty() ? a.log : a.truth).string(), "",
                     std::to_string(query.size()) + " true poses for " + std::to_string(log.size()) + " scans",
                     "see --truth");
  }
  return Truth{mapping::MapTruth(map, true_map), std::move(query)};
}

void print(const localization::RelocalizationSummary& s) {
  std::printf("scans %zu, placed %zu (%.1f %%), first answer ", s.scans, s.answered,
              s.scans > 0 ? 100.0 * static_cast<double>(s.answered) / static_cast<double>(s.scans) : 0.0);
  std::printf(s.first_answer_s < 0.0 ? "none" : "after %.1f s of driving", s.first_answer_s);
  std::printf(", lost %zu times, found again %zu times; %.2f s a scan\n", s.losses, s.recoveries,
              s.scans > 0 ? s.seconds / static_cast<double>(s.scans) : 0.0);
  if (s.judged > 0) {
    std::printf("against the truth: %zu of %zu answers wrong (over 0.6 m or 5 deg), median error %.2f m\n", s.wrong,
                s.judged, s.median_error_m);
  }
}

int relocalize(const RelocalizeArguments& a, const Globals& globals) {
  const std::filesystem::path partial = a.output.string() + ".partial";
  for (const std::filesystem::path& taken : {a.output, partial}) {
    if (std::filesystem::exists(taken)) {
      throw InputError(taken.string(), "", "is there already and is never overwritten", "choose another name for -o");
    }
  }
  const workflows::ProgramOptions options = globals.options();
  const std::unique_ptr<io::DriveLog> log = io::open_log(a.log, options.log);
  map_store::RunFolder::open(a.run);
  const std::optional<Truth> truth = read_truth(a, *log);
  const Stopwatch watch;
  const std::vector<localization::RelocalizedScan> placed = place_scans(a, options, *log);
  localization::RelocalizationSummary summary = summarize(placed);
  summary.seconds = watch.seconds();
  if (truth) {
    localization::judge(placed, truth->map, truth->query, summary);
  }
  std::filesystem::create_directories(partial);
  localization::write_relocalization(partial, placed, summary);
  std::filesystem::rename(partial, a.output);
  print(summary);
  return 0;
}

}  // namespace

Action set_up_relocalize(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<RelocalizeArguments>();
  declare(command, *arguments);
  return [arguments, &globals] { return relocalize(*arguments, globals); };
}

}  // namespace loopmark::app

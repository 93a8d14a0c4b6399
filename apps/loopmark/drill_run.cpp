// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "drill_run.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/slam/map_truth.hpp"
#include "loopmark/slam/run_place_map.hpp"
#include "map_run.hpp"

namespace loopmark::app {
namespace {

constexpr double kMappedM = 10.0;  ///< scans of another drive must be so near to one of the map

bool is_raw(Compensation compensation) {
  return compensation != Compensation::kCompensated && compensation != Compensation::kUnknown;
}

/// Reads scans so that logs of any compensation can be mixed: every point has a time, zero where it needs none.
std::function<Scan(std::size_t)> reader(std::shared_ptr<const DriveLog> log, Compensation compensation) {
  SweepModel sweep = log->info().sweep.value_or(SweepModel{});
  sweep.clockwise = compensation != Compensation::kRawCounterClockwise;
  return [log = std::move(log), compensation, sweep](std::size_t index) {
    Scan scan = log->read(index);
    if (!is_raw(compensation)) {
      scan.cloud.time_offset_s.assign(scan.cloud.size(), 0.0F);
    } else if (compensation != Compensation::kRawGivenTimes) {
      scan.cloud.time_offset_s = times_from_azimuth(scan.cloud.points, sweep);
    }
    return scan;
  };
}

/// The log that a run was made of.
std::filesystem::path log_of(const OpenedRun& run, const DrillJob& job) {
  if (!job.log.empty()) {
    return job.log;
  }
  const std::filesystem::path file = run.folder / "records/job.json";
  std::filesystem::path log;
  if (std::filesystem::exists(file)) {
    try {
      log = nlohmann::json::parse(read_file(file)).at("log").get<std::string>();
    } catch (const nlohmann::json::exception& error) {
      throw InputError(file.string(), "", error.what(), "say where the run's log is: --log LOG");
    }
  }
  if (log.empty() || !std::filesystem::exists(log)) {
    throw InputError(run.folder.name().string(), "",
                     log.empty() ? "does not say which log it was made of" : "its log " + log.string() + " is gone",
                     "say where the run's log is: --log LOG");
  }
  return log;
}

/// Scans that are fed are none that the map holds. Where nearly all scans are keyframes, every other one is kept out of
/// the map instead.
std::vector<std::size_t> keyframes_left_out(const OpenedRun& run, const SolvedMap& map) {
  std::vector<std::size_t> out;
  if (2 * map.keyframes.size() > run.scans.size()) {
    for (std::size_t k = 1; k < map.keyframes.size(); k += 2) {
      out.push_back(map.keyframes[k].number);
    }
  }
  return out;
}

std::vector<DrillScan> scans_to_feed(const OpenedRun& run, const SolvedMap& map,
                                     const std::vector<PlaceCharacter>& places,
                                     const std::vector<std::size_t>& left_out) {
  std::vector<DrillScan> scans;
  std::size_t before = 0;  // keyframe at or before the scan
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    const ScanRecord& record = run.scans[i];
    before = record.keyframe.value_or(before);
    const bool in_map = record.keyframe && !std::binary_search(left_out.begin(), left_out.end(), *record.keyframe);
    if (record.state != ScanState::kDamaged && map.component[i] == 0 && !in_map) {
      scans.push_back({i, record.stamp_s, map.T_map_scan[i], places[before].stratum});
    }
  }
  return scans;
}

std::vector<Pose> truth_of_map(const OpenedRun& run, const DrillJob& job) {
  const std::filesystem::path file = job.map_truth.empty() ? truth_file(run.folder) : job.map_truth;
  if (!std::filesystem::exists(file)) {
    throw InputError(run.folder.name().string(), "", "true poses of its scans are needed to judge another drive",
                     "give --map-truth FILE");
  }
  std::vector<Pose> truth = read_trajectory(file).poses;
  if (truth.size() != run.scans.size()) {
    throw InputError(
        file.string(), "",
        std::to_string(truth.size()) + " poses for " + std::to_string(run.scans.size()) + " scans of the run");
  }
  return truth;
}

std::vector<DrillScan> scans_of_drive(const OpenedRun& run, const SolvedMap& map,
                                      const std::vector<PlaceCharacter>& places, const DrillJob& job,
                                      const DriveLog& drive) {
  const std::vector<Pose> truth = job.drive_truth.empty() ? drive.truth() : read_trajectory(job.drive_truth).poses;
  if (truth.size() != drive.size()) {
    throw InputError((job.drive_truth.empty() ? job.drive : job.drive_truth).string(), "",
                     std::to_string(truth.size()) + " true poses for " + std::to_string(drive.size()) + " scans",
                     "give the true poses of the other drive, in the world of the map's: --truth FILE");
  }
  const MapTruth world(map.T_map_scan, truth_of_map(run, job));
  std::vector<DrillScan> scans;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    if (world.distance(truth[i]) < kMappedM) {
      const Pose T_map_lidar = world.in_map(truth[i]);
      const auto nearer = [&](const Pose& a, const Pose& b) {
        return (a.translation() - T_map_lidar.translation()).norm() <
               (b.translation() - T_map_lidar.translation()).norm();
      };
      const auto keyframe = std::min_element(map.T_map_keyframe.begin(), map.T_map_keyframe.end(), nearer);
      scans.push_back({i, drive.stamp_s(i), T_map_lidar,
                       places[static_cast<std::size_t>(keyframe - map.T_map_keyframe.begin())].stratum});
    }
  }
  if (scans.empty()) {
    throw InputError(job.drive.string(), "", "by its true poses it never comes within 10 m of the map",
                     "both drives' true poses must be in one world");
  }
  return scans;
}

/// An event is the same whichever others are run.
std::vector<DrillEvent> chosen(const std::vector<DrillEvent>& planned, const std::vector<std::size_t>& only) {
  if (only.empty()) {
    return planned;
  }
  std::vector<DrillEvent> events;
  for (const std::size_t number : only) {
    const auto event =
        std::find_if(planned.begin(), planned.end(), [&](const DrillEvent& e) { return e.number == number; });
    if (event == planned.end()) {
      throw InputError("--only", "", "there is no event " + std::to_string(number) + " in this drill", "see --events");
    }
    events.push_back(*event);
  }
  return events;
}

std::vector<DrillOutcome> run_events(const DrillStage& stage, const std::vector<DrillEvent>& events,
                                     const DrillOptions& options) {
  std::vector<DrillOutcome> outcomes(events.size());
  Progress progress("events", events.size());
  std::mutex mutex;
  std::size_t recovered = 0;
  std::size_t wrong = 0;
  parallel_for(events.size(), [&](std::size_t i) {
    check_interrupt();
    outcomes[i] = run_event(stage, events[i], options);
    const std::scoped_lock lock(mutex);
    recovered += succeeded(outcomes[i], options) ? 1 : 0;
    wrong += outcomes[i].verdict == DrillVerdict::kWrong ? 1 : 0;
    progress.add(1, std::to_string(recovered) + " recovered in time, " + std::to_string(wrong) + " wrong");
  });
  return outcomes;
}

}  // namespace

DrillResult run_drill(const DrillJob& job, const std::string& title, const AppOptions& options) {
  check(options.drill);
  const OpenedRun run = open_run(job.run);
  const std::shared_ptr<const DriveLog> log = open_log(log_of(run, job), options.log);
  if (log->size() != run.scans.size()) {
    throw InputError(
        log->info().path.string(), "",
        std::to_string(log->size()) + " scans, but the run was made of " + std::to_string(run.scans.size()),
        "give the log that the run was made of: --log LOG");
  }
  const SolvedMap map = run.solve();
  const std::vector<PlaceCharacter> places = characterise_places(run.folder, map);
  const std::vector<std::size_t> left_out = keyframes_left_out(run, map);
  DrillResult result;
  result.run = title;
  result.drive = job.drive.string();
  result.options = options.drill;
  result.T_map_scan = map.T_map_scan;
  result.keyframes = map.keyframes.size() - left_out.size();
  result.left_out = left_out.size();

  DrillStage stage;
  stage.relocalization = options.relocalization;
  stage.odometry = options.odometry;
  stage.map = open_place_map(run.folder, map, options.relocalization, options.registration, left_out);
  const Compensation of_run = compensation_of(*log, run.options.slam);
  Compensation of_drive = Compensation::kCompensated;
  stage.run = {scans_to_feed(run, map, places, left_out), reader(log, of_run)};
  if (!job.drive.empty()) {
    const std::shared_ptr<const DriveLog> drive = open_log(job.drive, options.log);
    of_drive = compensation_of(*drive, options.slam);
    stage.other = {scans_of_drive(run, map, places, job, *drive), reader(drive, of_drive)};
  }
  stage.compensation = is_raw(of_run) || is_raw(of_drive) ? Compensation::kRawGivenTimes : Compensation::kCompensated;
  result.events = chosen(plan_drill(stage.run.scans, stage.other.scans, options.drill), job.only);
  result.outcomes = run_events(stage, result.events, options.drill);
  result.scans = stage.run.scans;
  result.drive_scans = stage.other.scans;
  return result;
}

}  // namespace loopmark::app

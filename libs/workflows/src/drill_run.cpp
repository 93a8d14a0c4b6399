// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/drill_run.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/localization/run_place_map.hpp"
#include "loopmark/mapping/map_truth.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows {
namespace {

constexpr double kMappedM = 10.0;  ///< scans of another drive must be so near to one of the map

bool is_raw(odometry::Compensation compensation) {
  return compensation != odometry::Compensation::kCompensated && compensation != odometry::Compensation::kUnknown;
}

/// Reads scans so that logs of any compensation can be mixed: every point has a time, zero where it needs none.
std::function<Scan(std::size_t)> reader(std::shared_ptr<const io::DriveLog> log, odometry::Compensation compensation) {
  cloud::SweepModel sweep = log->info().sweep.value_or(cloud::SweepModel{});
  sweep.clockwise = compensation != odometry::Compensation::kRawCounterClockwise;
  return [log = std::move(log), compensation, sweep](std::size_t index) {
    Scan scan = log->read(index);
    if (!is_raw(compensation)) {
      scan.cloud.time_offset_s.assign(scan.cloud.size(), 0.0F);
    } else if (compensation != odometry::Compensation::kRawGivenTimes) {
      scan.cloud.time_offset_s = cloud::times_from_azimuth(scan.cloud.points, sweep);
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
      log = nlohmann::json::parse(storage::read_file(file)).at("log").get<std::string>();
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
std::vector<std::size_t> keyframes_left_out(const OpenedRun& run, const mapping::SolvedMap& map) {
  std::vector<std::size_t> out;
  if (2 * map.keyframes.size() > run.scans.size()) {
    for (std::size_t k = 1; k < map.keyframes.size(); k += 2) {
      out.push_back(map.keyframes[k].number);
    }
  }
  return out;
}

std::vector<kidnap_benchmark::DrillScan> scans_to_feed(const OpenedRun& run, const mapping::SolvedMap& map,
                                                       const std::vector<kidnap_benchmark::PlaceCharacter>& places,
                                                       const std::vector<std::size_t>& left_out) {
  std::vector<kidnap_benchmark::DrillScan> scans;
  std::size_t before = 0;  // keyframe at or before the scan
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    const map_store::ScanRecord& record = run.scans[i];
    before = record.keyframe.value_or(before);
    const bool in_map = record.keyframe && !std::binary_search(left_out.begin(), left_out.end(), *record.keyframe);
    if (record.state != map_store::ScanState::kDamaged && map.component[i] == 0 && !in_map) {
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
  std::vector<double> stamps_s;
  for (const map_store::ScanRecord& scan : run.scans) {
    stamps_s.push_back(scan.stamp_s);
  }
  std::vector<Pose> truth = job.map_truth.empty()
                                ? io::read_trajectory(file).poses
                                : io::poses_of_scans(io::read_trajectory(file), stamps_s, file.string());
  if (truth.size() != run.scans.size()) {
    throw InputError(
        file.string(), "",
        std::to_string(truth.size()) + " poses for " + std::to_string(run.scans.size()) + " scans of the run");
  }
  return truth;
}

std::vector<kidnap_benchmark::DrillScan> scans_of_drive(const OpenedRun& run, const mapping::SolvedMap& map,
                                                        const std::vector<kidnap_benchmark::PlaceCharacter>& places,
                                                        const DrillJob& job, const io::DriveLog& drive) {
  std::vector<double> stamps_s;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    stamps_s.push_back(drive.stamp_s(i));
  }
  const std::vector<Pose> truth = job.drive_truth.empty() ? drive.truth()
                                                          : io::poses_of_scans(io::read_trajectory(job.drive_truth),
                                                                               stamps_s, job.drive_truth.string());
  if (truth.size() != drive.size()) {
    throw InputError((job.drive_truth.empty() ? job.drive : job.drive_truth).string(), "",
                     std::to_string(truth.size()) + " true poses for " + std::to_string(drive.size()) + " scans",
                     "give the true poses of the other drive, in the world of the map's: --truth FILE");
  }
  const mapping::MapTruth world(map.T_map_scan, truth_of_map(run, job));
  std::vector<kidnap_benchmark::DrillScan> scans;
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
std::vector<kidnap_benchmark::DrillEvent> chosen(const std::vector<kidnap_benchmark::DrillEvent>& planned,
                                                 const std::vector<std::size_t>& only) {
  if (only.empty()) {
    return planned;
  }
  std::vector<kidnap_benchmark::DrillEvent> events;
  for (const std::size_t number : only) {
    const auto event = std::find_if(planned.begin(), planned.end(),
                                    [&](const kidnap_benchmark::DrillEvent& e) { return e.number == number; });
    if (event == planned.end()) {
      throw InputError("--only", "", "there is no event " + std::to_string(number) + " in this drill", "see --events");
    }
    events.push_back(*event);
  }
  return events;
}

std::vector<kidnap_benchmark::DrillOutcome> run_events(const kidnap_benchmark::DrillStage& stage,
                                                       const std::vector<kidnap_benchmark::DrillEvent>& events,
                                                       const kidnap_benchmark::DrillOptions& options) {
  std::vector<kidnap_benchmark::DrillOutcome> outcomes(events.size());
  Progress progress("drill", "events", events.size());
  std::mutex mutex;
  std::size_t recovered = 0;
  std::size_t wrong = 0;
  parallel_for(events.size(), [&](std::size_t i) {
    check_interrupt();
    outcomes[i] = kidnap_benchmark::run_event(stage, events[i], options);
    const std::scoped_lock lock(mutex);
    recovered += kidnap_benchmark::succeeded(outcomes[i], options) ? 1 : 0;
    wrong += outcomes[i].verdict == kidnap_benchmark::DrillVerdict::kWrong ? 1 : 0;
    progress.add(1, std::to_string(recovered) + " recovered in time, " + std::to_string(wrong) + " wrong");
  });
  return outcomes;
}

}  // namespace

DrillResult run_drill(const DrillJob& job, const std::string& title, const ProgramOptions& options) {
  check(options.drill);
  const OpenedRun run = open_run(job.run);
  const std::shared_ptr<const io::DriveLog> log = io::open_log(log_of(run, job), options.log);
  if (log->size() != run.scans.size()) {
    throw InputError(
        log->info().path.string(), "",
        std::to_string(log->size()) + " scans, but the run was made of " + std::to_string(run.scans.size()),
        "give the log that the run was made of: --log LOG");
  }
  const mapping::SolvedMap map = run.solve();
  const std::vector<kidnap_benchmark::PlaceCharacter> places = kidnap_benchmark::characterise_places(run.folder, map);
  const std::vector<std::size_t> left_out = keyframes_left_out(run, map);
  DrillResult result;
  result.run = title;
  result.drive = job.drive.string();
  result.options = options.drill;
  result.T_map_scan = map.T_map_scan;
  result.keyframes = map.keyframes.size() - left_out.size();
  result.left_out = left_out.size();

  kidnap_benchmark::DrillStage stage;
  stage.relocalization = options.relocalization;
  stage.odometry = options.odometry;
  stage.map = localization::open_place_map(run.folder, map, options.relocalization, options.registration, left_out);
  const odometry::Compensation of_run = compensation_of(*log, run.options.slam).used;
  odometry::Compensation of_drive = odometry::Compensation::kCompensated;
  stage.run = {scans_to_feed(run, map, places, left_out), reader(log, of_run)};
  if (!job.drive.empty()) {
    const std::shared_ptr<const io::DriveLog> drive = io::open_log(job.drive, options.log);
    of_drive = compensation_of(*drive, options.slam).used;
    stage.other = {scans_of_drive(run, map, places, job, *drive), reader(drive, of_drive)};
  }
  stage.compensation = is_raw(of_run) || is_raw(of_drive) ? odometry::Compensation::kRawGivenTimes
                                                          : odometry::Compensation::kCompensated;
  result.events = chosen(kidnap_benchmark::plan_drill(stage.run.scans, stage.other.scans, options.drill), job.only);
  result.outcomes = run_events(stage, result.events, options.drill);
  result.scans = stage.run.scans;
  result.drive_scans = stage.other.scans;
  return result;
}

}  // namespace loopmark::workflows

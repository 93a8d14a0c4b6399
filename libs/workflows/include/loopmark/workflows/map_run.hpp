// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/mapping/map_components.hpp"
#include "loopmark/mapping/map_verdict.hpp"
#include "loopmark/mapping/mapper.hpp"
#include "loopmark/mapping/trajectory_metrics.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::workflows {

/// What `loopmark map` is asked to do; kept in the run folder, so that it can be resumed.
struct MapJob {
  std::filesystem::path log;
  std::filesystem::path truth;              ///< trajectory file; empty: what lies beside the scans, if anything
  std::vector<std::string> arguments = {};  ///< of the process that began
  std::vector<std::vector<std::string>> resumed = {};  ///< of those that went on
};

/// Seconds spent in each part of a run by this process.
struct MapTimes {
  double reading = 0.0;   ///< waiting for scans
  double odometry = 0.0;  ///< keyframes included
  double loops = 0.0;
  double solving = 0.0;
  double products = 0.0;
  double whole = 0.0;
};

/// What became of one drive of a run that was merged from several.
struct DriveSummary {
  std::string name;
  std::string log;
  bool belongs = true;         ///< false: left out of the run
  std::size_t first_scan = 0;  ///< in the run; of a drive that belongs
  std::size_t scans = 0;
  std::size_t keyframes = 0;
  std::size_t in_map = 0;  ///< keyframes that have a place in the map
  std::string reason;      ///< why it was left out
  std::optional<mapping::AbsoluteError>
      absolute;  ///< of its scans in the map against its own truth, fitted by themselves
};

/// What was found between two drives, by their names.
struct InterSessionSummary {
  std::string first;
  std::string second;
  std::size_t candidates = 0;
  std::size_t accepted = 0;
  std::size_t checked = 0;
  std::size_t agree = 0;
  double best_p = 0.0;
};

/// What a run came to.
struct MapSummary {
  std::size_t scans = 0;
  std::size_t damaged = 0;
  std::size_t recovered = 0;
  std::size_t keyframes = 0;
  std::size_t candidates = 0;
  std::size_t loops = 0;  ///< accepted
  std::vector<mapping::MapComponent> components;
  double path_m = 0.0;
  double duration_s = 0.0;  ///< from the first to the last stamp
  std::string compensation;
  std::optional<mapping::AbsoluteError> absolute;           ///< of the scans that have a place in the map
  std::optional<mapping::AbsoluteError> absolute_odometry;  ///< of the same, before the loops
  std::optional<mapping::KittiError> kitti;
  std::vector<mapping::MapDoubt> doubts;                 ///< empty: the map is good as far as can be told
  std::vector<std::string> damage;                       ///< a line for each damaged scan
  std::vector<DriveSummary> drives;                      ///< of a merged run; else empty
  std::vector<InterSessionSummary> inter_session_loops;  ///< found when they were merged
};

struct MapOutcome {
  MapSummary summary;
  MapTimes times;
};

/// How the scans of a log are taken, and how that is known, for people.
struct LogCompensation {
  odometry::Compensation used = odometry::Compensation::kCompensated;
  std::string text;
};

/// Whether and how the log's scans are deskewed: as the options say, else as the log says, else as is measured on its
/// scans. Throws InputError when the options want times of points that the log does not have.
LogCompensation compensation_of(const io::DriveLog& log, const mapping::SlamOptions& options);

/// What is done to the scans, for people.
std::string compensation_text(odometry::Compensation compensation);

/// From a log to a whole run folder. Throws InputError (the partial run stays) or Interrupted (it can be resumed).
MapOutcome run_map(map_store::RunFolder folder, const MapJob& job, const ProgramOptions& options);

/// How far the search for loops is, on one line. Parts that nothing joins bring more candidates as it goes.
class LoopProgress {
 public:
  void show(std::size_t done, std::size_t total);

 private:
  std::unique_ptr<Progress> progress_;
  std::size_t shown_ = 0;
  std::size_t total_ = 0;
};

/// Trajectories, occupancy, clouds and MRPT's files of a solved map.
void write_maps(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map,
                const ProgramOptions& options);

/// The time, as manifests name it (ISO 8601, UTC).
std::string utc_now();

/// records/truth.tum: the true pose of every scan, where it was known.
inline std::filesystem::path truth_file(const map_store::RunFolder& folder) { return folder / "records/truth.tum"; }

/// What the map came to, but for `compensation`. `truth`: one pose for every scan, or none.
MapSummary summarize(const std::vector<map_store::ScanRecord>& scans, const std::vector<map_store::LoopRecord>& loops,
                     const mapping::SolvedMap& map, const std::vector<Pose>& truth);

/// summary.json: no times, so that the same run gives the same bytes. timings.json: the times.
void write_summary(const map_store::RunFolder& folder, const MapSummary& summary, const MapTimes& times);

/// report.html: the map as a page, with its loops, findings, plots and tables. `earlier_page`: of the same keyframes,
/// whose cloud is taken; empty: made from the keyframes.
void write_map_report(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                      const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map,
                      const MapSummary& summary, const MapTimes& times, const std::vector<Pose>& truth,
                      double min_loop_p, const std::filesystem::path& earlier_page = {});

/// The table at the end, for people.
std::string closing_table(const MapOutcome& outcome);

}  // namespace loopmark::workflows

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What a drive log is, found out by reading it: `loopmark doctor`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/io/dataset.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/recorded_log.hpp"

namespace loopmark::io {

/// What the stamps of a log show.
struct StampFacts {
  double duration_s = 0.0;
  double rate_hz = 0.0;  ///< one over the median spacing; 0 with fewer than two stamps
  bool regular = false;  ///< nine of ten spacings within a fifth of the median
  struct Gap {
    std::size_t before = 0;  ///< the scan at the far end of the gap
    double seconds = 0.0;
  };
  std::vector<Gap> gaps;               ///< spacings above 1.5 times the median, in regular logs
  std::vector<std::size_t> repeated;   ///< scans with the stamp of the scan before
  std::vector<std::size_t> backwards;  ///< scans with a stamp below that of the scan before
};
StampFacts examine_stamps(const std::vector<double>& stamps_s);

/// What a cloud shows of the sensor that took it.
struct SensorGuess {
  std::size_t beams = 0;    ///< 0: cannot be told (thinned clouds)
  std::string beams_from;   ///< "rings", "order of the points", "elevations"
  double lowest_deg = 0.0;  ///< elevation of the lowest and highest beam
  double highest_deg = 0.0;
  double farthest_m = 0.0;  ///< range that one point in a thousand exceeds
  std::string name;         ///< "HDL-64E", ...; empty: none that is known
};
SensorGuess guess_sensor(const PointCloud& cloud);

struct DamagedScanFact {
  std::size_t index = 0;
  std::string problem;
};

/// How the times of the points within a sweep are known.
enum class PointTimeSource { kMissing, kInFiles, kRebuilt, kMixed };

/// Everything about one log.
struct LogReport {
  LogInfo info;
  std::optional<RecordingFacts> recording;  ///< of bags, MCAP files and captures
  std::size_t scans = 0;
  std::size_t usable = 0;
  std::size_t points_least = 0, points_median = 0, points_most = 0;  ///< a usable scan
  bool has_intensity = false;
  bool has_ring = false;
  std::size_t viewpoints = 0;  ///< scans whose file has a VIEWPOINT that is not applied
  DroppedPoints dropped;       ///< sum over all scans
  PointTimeSource point_times = PointTimeSource::kMissing;
  double sweep_first_s = 0.0, sweep_last_s = 0.0;  ///< median range of the points' times around the stamp
  StampFacts stamps;
  SensorGuess sensor;
  std::vector<DamagedScanFact> damaged;
  std::vector<std::size_t> copies;  ///< scans with the very points of the scan before
  double truth_length_m = 0.0;      ///< length of the reference path
  std::string compensation;         ///< what was measured about motion compensation; empty: not measured
  std::string frame_problem;        ///< why the scans seem to be in no sensor's frame; empty: nothing speaks for it
};

/// Reads every scan of the log once, in parallel, and changes nothing. Throws Interrupted; damaged
/// scans are part of the report.
LogReport examine_log(const DriveLog& log);

/// The command to run next.
std::string next_command(const LogReport& report);

std::string report_text(const LogReport& report);
std::string report_json(const LogReport& report);

/// One drive of a data set: what is there and whether its first scan can be read.
struct SessionReport {
  SessionInfo session;
  std::size_t scans = 0;
  std::size_t first_frame = 0;
  std::size_t last_frame = 0;
  std::size_t points = 0;  ///< of the first scan
  bool truth_given = false;
  std::string problem;  ///< why it cannot be used; empty when it can
};

struct DatasetReport {
  std::string layout;
  std::string description;
  std::filesystem::path root;
  std::vector<SessionReport> sessions;
};

/// Opens every drive that is there and reads its first scan.
DatasetReport examine_dataset(const Dataset& dataset);

std::string report_text(const DatasetReport& report);
std::string report_json(const DatasetReport& report);

}  // namespace loopmark::io

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// place_starts RUN RUN_TRUTH LOG LOG_TRUTH|- OUT.txt STARTS SECONDS [SCAN,SCAN...]: starts a relocalizer, which knows
/// nothing, at STARTS places spread over a log (or at the scans that are named), feeds it the scans of SECONDS of
/// driving as they are in the log, and writes one row a start for benchmarks/relocalization.py: scan; metres from its
/// true position to the nearest scan of the map; what the first scan gave (1 right, -1 wrong, 0 nothing); seconds of
/// driving until the first right pose (-1: none); metres driven until then or the end; answers; wrong ones; P(correct)
/// and error (metres, degrees) of the first wrong one, or of the last answer; why the last scan has no pose. Time in
/// which the sensor stands (below 0.3 m/s by its true poses) is no driving: up to 10 s of it are fed and not counted.
/// RUN_TRUTH, LOG_TRUTH: poses in one world; LOG_TRUTH "-": the log is of another world, every answer is wrong. Rows
/// come as starts are done.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string>

#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/localization/relocalization_report.hpp"
#include "loopmark/localization/relocalizer.hpp"
#include "loopmark/localization/run_place_map.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mapping/map_truth.hpp"
#include "loopmark/workflows/map_run.hpp"

namespace {

using namespace loopmark;

constexpr double kStands = 0.3;          // m/s
constexpr double kMostStandingS = 10.0;  // of a start

struct Stage {
  std::shared_ptr<const localization::PlaceMap> map;
  mapping::MapTruth truth;
  std::unique_ptr<io::DriveLog> log;
  std::vector<loopmark::Pose> query;  ///< empty: another world
  odometry::Compensation compensation;
};

struct Start {
  std::size_t scan = 0;
  double mapped_m = 1e6;
  int first_scan = 0;
  double right_s = -1.0;
  double driven_m = 0.0;
  int answers = 0;
  int wrong = 0;
  double p = 0.0;
  loopmark::PoseError error{1000.0, 180.0};
  std::string reason = "-";
};

loopmark::PoseError error_of(const Stage& stage, const localization::RelocalizedScan& answer) {
  return stage.query.empty() ? loopmark::PoseError{1000.0, 180.0}
                             : stage.truth.error(answer.T_map_lidar, stage.query[answer.scan]);
}

void take(const Stage& stage, const localization::RelocalizedScan& answer, double seconds, Start& start) {
  std::string reason = answer.reason.empty() ? "-" : answer.reason;
  std::replace(reason.begin(), reason.end(), ' ', '_');
  start.reason = reason;
  if (!answer.answered) {
    return;
  }
  const loopmark::PoseError error = error_of(stage, answer);
  const bool right = localization::is_right(error);
  ++start.answers;
  if (start.wrong == 0) {
    start.p = answer.p_correct;
    start.error = error;
  }
  start.wrong += right ? 0 : 1;
  start.right_s = right && start.right_s < 0.0 ? seconds : start.right_s;
  if (answer.scan == start.scan) {
    start.first_scan = right ? 1 : -1;
  }
}

Start started_at(const Stage& stage, std::size_t first, double limit_s) {
  Start start;
  start.scan = first;
  start.mapped_m = stage.query.empty() ? 1e6 : stage.truth.distance(stage.query[first]);
  localization::Relocalizer relocalizer(stage.map, {}, {}, stage.compensation,
                                        stage.log->info().sweep.value_or(cloud::SweepModel{}));
  const std::vector<loopmark::Pose> poses = stage.log->truth();
  double seconds = 0.0;
  double standing_s = 0.0;
  for (std::size_t i = first; i < stage.log->size(); ++i) {
    if (i > first) {
      const double gap_s = stage.log->stamp_s(i) - stage.log->stamp_s(i - 1);
      const double moved_m = poses.empty() ? 0.0 : (poses[i].translation() - poses[i - 1].translation()).norm();
      const bool stands = !poses.empty() && moved_m < kStands * gap_s && standing_s + gap_s <= kMostStandingS;
      (stands ? standing_s : seconds) += gap_s;
      start.driven_m += start.right_s < 0.0 ? moved_m : 0.0;
    }
    if (seconds > limit_s + 1e-6) {
      break;
    }
    take(stage, relocalizer.add(stage.log->read(i)), seconds, start);
  }
  return start;
}

void write_row(std::ostream& out, const Start& s) {
  out << s.scan << ' ' << s.mapped_m << ' ' << s.first_scan << ' ' << s.right_s << ' ' << s.driven_m << ' ' << s.answers
      << ' ' << s.wrong << ' ' << s.p << ' ' << s.error.translation_m << ' ' << s.error.rotation_deg << ' ' << s.reason
      << std::endl;
}

std::vector<std::size_t> numbers(const std::string& text) {
  std::vector<std::size_t> all;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    all.push_back(std::stoul(word));
  }
  return all;
}

/// `count` numbers at even steps below `end`.
std::vector<std::size_t> spread(std::size_t count, std::size_t end) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back(i * end / count);
  }
  return all;
}

int run(int argc, char** argv) {
  const map_store::RunFolder folder = map_store::RunFolder::open(argv[1]);
  const map_store::RunRecords records = map_store::read_run_records(folder);
  const mapping::SolvedMap solved = mapping::solve_map(records.scans, records.loops, {}, {});
  std::unique_ptr<io::DriveLog> log = io::open_log(argv[3]);
  const odometry::Compensation compensation = app::compensation_of(*log, {});
  const bool elsewhere = std::string(argv[4]) == "-";
  const Stage stage{localization::open_place_map(folder, solved, {}),
                    mapping::MapTruth(solved.T_map_scan, io::read_trajectory(argv[2]).poses), std::move(log),
                    elsewhere ? std::vector<loopmark::Pose>() : io::read_trajectory(argv[4]).poses, compensation};
  const auto count = static_cast<std::size_t>(std::atoi(argv[6]));
  const double limit_s = std::atof(argv[7]);
  const double end_s = stage.log->stamp_s(stage.log->size() - 1) - limit_s;
  std::size_t usable = stage.log->size();
  while (usable > 1 && stage.log->stamp_s(usable - 1) > end_s) {
    --usable;
  }
  const std::vector<std::size_t> starts = argc > 8 ? numbers(argv[8]) : spread(std::min(count, usable), usable);
  for (const std::size_t start : starts) {
    if (start >= stage.log->size()) {
      std::fprintf(stderr, "place_starts: there is no scan %zu; %s has %zu\n", start, argv[3], stage.log->size());
      return 2;
    }
  }
  std::ofstream out(argv[5]);
  std::mutex mutex;
  loopmark::Progress progress("starts", starts.size());
  loopmark::parallel_for(starts.size(), [&](std::size_t i) {
    const Start start = started_at(stage, starts[i], limit_s);
    const std::scoped_lock lock(mutex);
    write_row(out, start);
    progress.add();
  });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 8) {
    std::fprintf(stderr, "usage: place_starts RUN RUN_TRUTH LOG LOG_TRUTH|- OUT.txt STARTS SECONDS [SCAN,SCAN...]\n");
    return 2;
  }
  return run(argc, argv);
}

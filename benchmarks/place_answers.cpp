// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// place_answers RUN RUN_TRUTH LOG LOG_TRUTH OUT.txt [EVERY [FIRST]]: asks the map of a run where each EVERY-th scan of
/// a log is, each on its own, and writes one row an answer for scripts/fit_places.py and benchmarks/relocalization.py:
/// scan, metres from its true position to the nearest keyframe, symmetric overlap with the best of the three nearest
/// ones, errors of the answer (metres, degrees), P(correct), log-odds, whether it is given, then the evidence by name
/// and "truth", the engine's log-odds at the true pose itself (high where no answer is right: its place was not asked).
/// A scan without any answer has a row of P 0. It says what a search takes in processor time, on all threads together.
/// RUN_TRUTH, LOG_TRUTH: poses in one world (KITTI or TUM); LOG_TRUTH "-": the log is of another world, no answer is
/// right.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

#include "loopmark/cloud/deskew.hpp"
#include "loopmark/cloud/overlap.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/io/trajectory.hpp"
#include "loopmark/localization/relocalization_report.hpp"
#include "loopmark/localization/run_place_map.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mapping/map_truth.hpp"

namespace {

using namespace loopmark;

struct Reference {
  map_store::RunFolder run;
  mapping::SolvedMap solved;
  mapping::MapTruth map;
  std::vector<loopmark::Pose> query;  ///< empty: another world
};

struct Nearness {
  double keyframe_m = 1e6;
  double overlap = 0.0;
  double log_odds = -20.0;  ///< that the map gives the true pose
};

Nearness nearness(const Reference& reference, const localization::PlaceMap& map, std::size_t scan,
                  const loopmark::PointCloud& cloud) {
  Nearness result;
  if (reference.query.empty()) {
    return result;
  }
  const loopmark::Pose T_map_lidar = reference.map.in_map(reference.query[scan]);
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t k = 0; k < reference.solved.keyframes.size(); ++k) {
    near.emplace_back((reference.solved.T_map_keyframe[k].translation() - T_map_lidar.translation()).norm(), k);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min<std::size_t>(near.size(), 3));
  result.keyframe_m = near.front().first;
  for (const auto& [distance, k] : near) {
    const loopmark::PointCloud seen = io::read_point_file(reference.run.keyframe(k, "pcd")).cloud;
    const loopmark::Pose T_keyframe_lidar = reference.solved.T_map_keyframe[k].inverse() * T_map_lidar;
    result.overlap = std::max(result.overlap, cloud::overlap(cloud, seen, T_keyframe_lidar).symmetric);
  }
  for (const localization::LocalizationHypothesis& answer : map.judge(cloud, {T_map_lidar})) {
    if (localization::is_right(loopmark::pose_error(answer.T_map_lidar, T_map_lidar))) {
      result.log_odds = std::max(result.log_odds, answer.log_odds);
    }
  }
  return result;
}

/// The scan without its sensor's own motion, which is taken from the true poses of its neighbours.
loopmark::PointCloud deskewed_scan(const io::DriveLog& log, const std::vector<loopmark::Pose>& truth, std::size_t i) {
  loopmark::PointCloud cloud = log.read(i).cloud;
  if (log.info().motion_compensated.value_or(true) || truth.empty()) {
    return cloud;
  }
  const std::size_t before = i > 0 ? i - 1 : i;
  const std::size_t behind = std::min(i + 1, log.size() - 1);
  const loopmark::Vector6d velocity =
      loopmark::log_se3(truth[before].inverse() * truth[behind]) / (log.stamp_s(behind) - log.stamp_s(before));
  const bool timed = cloud.time_offset_s.size() == cloud.size();
  cloud.points =
      cloud::deskewed(cloud.points,
                      timed ? cloud.time_offset_s
                            : cloud::times_from_azimuth(cloud.points, log.info().sweep.value_or(cloud::SweepModel{})),
                      velocity);
  return cloud;
}

void write_answers(std::ofstream& out, std::size_t scan,
                   const std::vector<localization::LocalizationHypothesis>& answers, const Reference& reference,
                   const Nearness& near) {
  const std::vector<double> p = localization::probabilities(answers);
  localization::PlaceBeliefs beliefs({});
  beliefs.add(answers, loopmark::Pose::Identity());
  const bool given = beliefs.decided() && beliefs.best()->p >= localization::RelocalizationOptions().min_p_correct;
  if (answers.empty()) {
    out << scan << ' ' << near.keyframe_m << ' ' << near.overlap << " 1000 180 0 -20 0\n";
  }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    loopmark::PoseError error{1000.0, 180.0};
    if (!reference.query.empty()) {
      error = reference.map.error(answers[i].T_map_lidar, reference.query[scan]);
    }
    out << scan << ' ' << near.keyframe_m << ' ' << near.overlap << ' ' << error.translation_m << ' '
        << error.rotation_deg << ' ' << p[i] << ' ' << answers[i].log_odds << ' ' << (given && i == 0 ? 1 : 0);
    for (const auto& [name, value] : answers[i].evidence) {
      out << ' ' << name << '=' << value;
    }
    out << " truth=" << near.log_odds << '\n';
  }
}

int run(int argc, char** argv) {
  const map_store::RunFolder folder = map_store::RunFolder::open(argv[1]);
  const map_store::RunRecords records = map_store::read_run_records(folder);
  mapping::SolvedMap solved = mapping::solve_map(records.scans, records.loops, {}, {});
  const auto map = localization::open_place_map(folder, solved, {});
  const mapping::MapTruth truth(solved.T_map_scan, io::read_trajectory(argv[2]).poses);
  const Reference reference{
      folder, std::move(solved), truth,
      std::string(argv[4]) == "-" ? std::vector<loopmark::Pose>() : io::read_trajectory(argv[4]).poses};
  const auto log = io::open_log(argv[3]);
  const std::vector<loopmark::Pose> truth_of_log = log->truth();
  const std::size_t every = argc > 6 ? static_cast<std::size_t>(std::atoi(argv[6])) : 1;
  const std::size_t first = argc > 7 ? static_cast<std::size_t>(std::atoi(argv[7])) : 0;
  std::ofstream out(argv[5]);
  std::clock_t searching = 0;
  int searched = 0;
  loopmark::Progress progress("scans", (log->size() - first + every - 1) / every);
  for (std::size_t i = first; i < log->size(); i += every, progress.add()) {
    const loopmark::PointCloud cloud = deskewed_scan(*log, truth_of_log, i);
    const std::clock_t before = std::clock();
    const std::vector<localization::LocalizationHypothesis> answers =
        map->search(cloud, localization::RelocalizationOptions().places, {});
    searching += std::clock() - before;
    ++searched;
    write_answers(out, i, answers, reference, nearness(reference, *map, i, cloud));
  }
  std::printf("a search: %.3f s of processor time\n",
              static_cast<double>(searching) / CLOCKS_PER_SEC / std::max(1, searched));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr, "usage: place_answers RUN RUN_TRUTH LOG LOG_TRUTH|- OUT.txt [EVERY [FIRST]]\n");
    return 2;
  }
  return run(argc, argv);
}

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What a map came to.
#include <algorithm>

#include "loopmark/workflows/map_run.hpp"

namespace loopmark::workflows {
namespace {

/// Compares the scans that have a place in the map with the truth, where that is known.
void judge(const std::vector<map_store::ScanRecord>& scans, const mapping::SolvedMap& map,
           const std::vector<Pose>& truth, MapSummary& summary) {
  std::vector<Pose> solved;
  std::vector<Pose> odometry;
  std::vector<Pose> true_poses;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (map.component[i] == 0) {
      solved.push_back(map.T_map_scan[i]);
      odometry.push_back(scans[i].T_segment_lidar);
      true_poses.push_back(truth[i]);
    }
  }
  if (!true_poses.empty()) {
    summary.absolute = mapping::absolute_error(solved, true_poses);
    summary.absolute_odometry = mapping::absolute_error(odometry, true_poses);
    summary.kitti = mapping::kitti_error(solved, true_poses);
  }
}

}  // namespace

MapSummary summarize(const std::vector<map_store::ScanRecord>& scans, const std::vector<map_store::LoopRecord>& loops,
                     const mapping::SolvedMap& map, const std::vector<Pose>& truth) {
  MapSummary s;
  s.scans = scans.size();
  for (const map_store::ScanRecord& scan : scans) {
    s.recovered += scan.state == map_store::ScanState::kRecovered ? 1 : 0;
    if (scan.state == map_store::ScanState::kDamaged) {
      ++s.damaged;
      s.damage.push_back(scan.problem);
    }
  }
  s.keyframes = map.keyframes.size();
  s.candidates = map.loops.size();
  s.loops = static_cast<std::size_t>(std::count_if(map.loops.begin(), map.loops.end(),
                                                   [](const mapping::LoopVerdict& loop) { return loop.accepted; }));
  s.components = mapping::map_components(scans, loops, map);
  s.path_m = map.keyframes.back().path_m;
  s.duration_s = scans.back().stamp_s - scans.front().stamp_s;
  s.doubts = mapping::doubts_of(scans, loops, map);
  judge(scans, map, truth, s);
  return s;
}

}  // namespace loopmark::workflows

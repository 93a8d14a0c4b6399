// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/mapping/solved_map.hpp"

#include <algorithm>
#include <cmath>

#include "loopmark/core/progress.hpp"

namespace loopmark::mapping {
namespace {

/// Covariance of the motion between two keyframes: the later one's alignment (wide along directions that nothing held),
/// drift over the distance, and what registration leaves where it placed the later one.
Matrix6d odometry_covariance(const Keyframe& from, const Keyframe& to, const SlamOptions& options) {
  const double distance = to.path_m - from.path_m;
  const double metres = options.drift_m_per_m * distance;
  const double radians = options.drift_deg_per_m * distance * M_PI / 180.0;
  const double loop_m = to.recovered ? options.loop_floor_m : 0.0;
  const double loop_rad = to.recovered ? options.loop_floor_deg * M_PI / 180.0 : 0.0;
  Vector6d drift;
  drift << Eigen::Vector3d::Constant(metres * metres + loop_m * loop_m),
      Eigen::Vector3d::Constant(radians * radians + loop_rad * loop_rad);
  const Matrix6d in_lidar = to.covariance + Matrix6d(drift.asDiagonal());
  const Matrix6d A = adjoint(from.T_segment_lidar.inverse() * to.T_segment_lidar);
  const Matrix6d in_from = A * in_lidar * A.transpose();
  return 0.5 * (in_from + in_from.transpose());
}

void add_odometry(SolvedMap& map, const SlamOptions& options) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& to = map.keyframes[i];
    map.graph.T_map_node.push_back(to.T_segment_lidar);
    if (i == 0 || map.keyframes[i - 1].segment != to.segment) {
      continue;
    }
    const Keyframe& from = map.keyframes[i - 1];
    map.graph.edges.push_back({i - 1, i, from.T_segment_lidar.inverse() * to.T_segment_lidar,
                               pose_graph::information_from_covariance(odometry_covariance(from, to, options),
                                                                       options.floor_m, options.floor_deg),
                               pose_graph::EdgeKind::kOdometry});
  }
}

/// The loops that may take part get an edge, the others a reason.
void add_loops(SolvedMap& map, const std::vector<map_store::LoopRecord>& loops, const SlamOptions& options,
               const std::vector<map_store::LoopDecision>& decisions) {
  map.loops.resize(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const map_store::LoopRecord& loop = loops[i];
    const std::optional<map_store::LoopOverride> loop_override =
        map_store::loop_override_of(decisions, loop.source, loop.target);
    const bool forced = loop_override == map_store::LoopOverride::kForce;
    if (loop_override == map_store::LoopOverride::kVeto) {
      map.loops[i].reason = to_string(*loop_override);
    } else if (!loop.answered && !forced) {
      map.loops[i].reason = loop.reason;
    } else if (loop.p_correct < options.min_loop_p && !forced) {
      map.loops[i].reason = "P(correct) below min_loop_p";
    } else if (!forced && map.keyframes[loop.source].segment == map.keyframes[loop.target].segment &&
               loop.T_target_source.translation().norm() > options.max_loop_m) {
      map.loops[i].reason = "seen from farther apart than max_loop_m";
    } else {
      map.loops[i].edge = map.graph.edges.size();
      map.graph.edges.push_back(
          {loop.target, loop.source, loop.T_target_source,
           pose_graph::information_from_covariance(loop.covariance, options.loop_floor_m, options.loop_floor_deg),
           forced ? pose_graph::EdgeKind::kForced : pose_graph::EdgeKind::kLoop});
    }
  }
}

void judge_loops(SolvedMap& map) {
  for (LoopVerdict& verdict : map.loops) {
    if (!verdict.edge) {
      continue;
    }
    const pose_graph::EdgeReport& report = map.solution.edges[*verdict.edge];
    const bool forced = map.graph.edges[*verdict.edge].kind == pose_graph::EdgeKind::kForced;
    verdict.accepted = report.verdict == pose_graph::EdgeVerdict::kAccepted;
    verdict.reason = forced             ? to_string(map_store::LoopOverride::kForce)
                     : verdict.accepted ? ""
                                        : to_string(report.verdict);
    verdict.weight = report.weight;
    verdict.chi2 = report.chi2;
  }
}

/// The component with most keyframes is the map. Poses stay as they are: each component has a frame of its own.
void put_largest_first(SolvedMap& map) {
  std::vector<pose_graph::PoseGraphComponent>& components = map.solution.components;
  const auto smaller = [](const pose_graph::PoseGraphComponent& a, const pose_graph::PoseGraphComponent& b) {
    return a.nodes.size() < b.nodes.size();
  };
  const auto largest = std::max_element(components.begin(), components.end(), smaller);
  std::rotate(components.begin(), largest, largest + 1);
  map.graph.anchors = {components.front().nodes.front()};
  for (std::size_t c = 0; c < components.size(); ++c) {
    components[c].anchored = c == 0;
    for (const std::size_t node : components[c].nodes) {
      map.solution.component_of[node] = c;
    }
  }
}

/// What the solution has moved a scan by: between the corrections of the keyframes before and behind it.
Pose correction(const SolvedMap& map, const std::vector<map_store::ScanRecord>& scans, std::size_t before,
                const map_store::ScanRecord& scan) {
  const auto of_keyframe = [&](std::size_t k) {
    return map.T_map_keyframe[k] * map.keyframes[k].T_segment_lidar.inverse();
  };
  const Pose first = of_keyframe(before);
  if (before + 1 == map.keyframes.size() || map.keyframes[before + 1].segment != scan.segment) {
    return first;
  }
  const double begin = scans[map.keyframes[before].scan].stamp_s;
  const double end = scans[map.keyframes[before + 1].scan].stamp_s;
  const double ratio = end > begin ? std::clamp((scan.stamp_s - begin) / (end - begin), 0.0, 1.0) : 0.0;
  return interpolate(first, of_keyframe(before + 1), ratio);
}

/// Damaged scans get poses between their neighbours'.
void fill_gaps(SolvedMap& map, const std::vector<map_store::ScanRecord>& scans) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].state != map_store::ScanState::kDamaged) {
      continue;
    }
    const auto good = [&](std::size_t k) {
      return scans[k].state != map_store::ScanState::kDamaged && scans[k].segment == scans[i].segment;
    };
    std::size_t before = i;
    std::size_t behind = i;
    while (before > 0 && !good(before)) {
      --before;
    }
    while (behind + 1 < scans.size() && !good(behind)) {
      ++behind;
    }
    before = good(before) ? before : behind;
    behind = good(behind) && map.component[behind] == map.component[before] ? behind : before;
    const double span = scans[behind].stamp_s - scans[before].stamp_s;
    const double ratio = span > 0.0 ? (scans[i].stamp_s - scans[before].stamp_s) / span : 0.0;
    map.T_map_scan[i] = interpolate(map.T_map_scan[before], map.T_map_scan[behind], std::clamp(ratio, 0.0, 1.0));
    map.covariance[i] = map.covariance[before] + Matrix6d::Identity();
    map.component[i] = map.component[before];
  }
}

void place_scans(SolvedMap& map, const std::vector<map_store::ScanRecord>& scans) {
  const std::vector<Matrix6d> marginals = pose_graph::marginal_covariances(map.graph, map.solution);
  map.T_map_scan.assign(scans.size(), Pose::Identity());
  map.covariance.assign(scans.size(), Matrix6d::Identity());
  map.component.assign(scans.size(), 0);
  std::size_t keyframe = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].state == map_store::ScanState::kDamaged) {
      continue;
    }
    keyframe = scans[i].keyframe ? *scans[i].keyframe : keyframe;
    map.T_map_scan[i] = correction(map, scans, keyframe, scans[i]) * scans[i].T_segment_lidar;
    map.component[i] = map.solution.component_of[keyframe];
    map.covariance[i] = marginals[keyframe];
    if (!scans[i].keyframe) {
      const Matrix6d A = adjoint(map.T_map_scan[i]);
      map.covariance[i] += A * scans[i].covariance * A.transpose();
    }
  }
  fill_gaps(map, scans);
}

}  // namespace

void DrivenPath::add(const map_store::ScanRecord& scan, std::vector<Keyframe>& keyframes) {
  if (scan.state == map_store::ScanState::kDamaged) {
    return;
  }
  if (started_ && segment_ == scan.segment) {
    path_m_ += (last_.inverse() * scan.T_segment_lidar).translation().norm();
  }
  started_ = true;
  segment_ = scan.segment;
  last_ = scan.T_segment_lidar;
  if (scan.keyframe) {
    keyframes.push_back({*scan.keyframe, scan.scan, scan.segment, scan.T_segment_lidar, scan.covariance, path_m_,
                         scan.state == map_store::ScanState::kRecovered});
  }
}

bool is_revisit(const Keyframe& earlier, const Keyframe& later, double gap_m) {
  constexpr double kDetour = 4.0;
  const double driven_m = later.path_m - earlier.path_m;
  const double apart_m = (later.T_segment_lidar.translation() - earlier.T_segment_lidar.translation()).norm();
  return driven_m > gap_m || (driven_m > 0.5 * gap_m && driven_m > kDetour * apart_m);
}

std::vector<Keyframe> keyframes_of(const std::vector<map_store::ScanRecord>& scans) {
  std::vector<Keyframe> keyframes;
  DrivenPath path;
  for (const map_store::ScanRecord& scan : scans) {
    path.add(scan, keyframes);
  }
  return keyframes;
}

SolvedMap solve_keyframes(const std::vector<Keyframe>& keyframes, const std::vector<map_store::LoopRecord>& loops,
                          const SlamOptions& options, const pose_graph::PoseGraphOptions& graph_options,
                          const std::vector<map_store::LoopDecision>& decisions) {
  SolvedMap map;
  map.keyframes = keyframes;
  add_odometry(map, options);
  add_loops(map, loops, options, decisions);
  map.graph.anchors = {0};
  map.solution = pose_graph::optimize(map.graph, graph_options);
  put_largest_first(map);
  map.T_map_keyframe = map.solution.T_map_node;
  map.components = map.solution.components.size();
  judge_loops(map);
  return map;
}

SolvedMap solve_map(const std::vector<map_store::ScanRecord>& scans, const std::vector<map_store::LoopRecord>& loops,
                    const SlamOptions& options, const pose_graph::PoseGraphOptions& graph_options,
                    const std::vector<map_store::LoopDecision>& decisions) {
  const Progress progress("solving the map");
  SolvedMap map = solve_keyframes(keyframes_of(scans), loops, options, graph_options, decisions);
  place_scans(map, scans);
  return map;
}

}  // namespace loopmark::mapping

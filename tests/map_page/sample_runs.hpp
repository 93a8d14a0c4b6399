// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Made-up runs whose map, loops and points are known, for pages.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "loopmark/map_page/map_page.hpp"

namespace loopmark::testing_support {

/// A run with a keyframe every `every` scans. Drives `place(i)`; its clouds are `cloud(keyframe)`.
struct SampleRun {
  std::vector<map_store::ScanRecord> scans;
  std::vector<map_store::LoopRecord> loops;
  mapping::SolvedMap map;
  std::vector<map_store::LoopDecision> decisions;
  std::vector<Pose> truth;
  std::string name = "a run";
  std::optional<map_page::AnswerLayer> answers;
  std::function<PointCloud(std::size_t)> cloud = [](std::size_t) { return PointCloud(); };

  map_page::MapPageInput input() const {
    return {.name = name,
            .run = name,
            .facts = {{"scans", std::to_string(scans.size())}},
            .note = "",
            .time_parts = {{"reading", 1.5}},
            .sessions = {},
            .tables = {},
            .edits = {},
            .records = {scans, loops, map, decisions, truth, 0.9},
            .answers = answers,
            .earlier_page = {},
            .keyframe_cloud = cloud};
  }

  void add_scan(const Pose& pose, bool keyframe, std::size_t component = 0) {
    map_store::ScanRecord scan;
    scan.scan = scans.size();
    scan.stamp_s = 46800.0 + 0.1 * static_cast<double>(scans.size());  // from 13:00:00
    scan.segment = component;
    scan.T_segment_lidar = pose;
    scan.inlier_share = 0.9;
    scan.velocity.head<3>() = Eigen::Vector3d(10.0, 0.0, 0.0);
    map.components = std::max(map.components, component + 1);
    map.solution.components.resize(map.components);
    map.T_map_scan.push_back(pose);
    map.covariance.push_back(0.01 * Matrix6d::Identity());
    map.covariance.back().bottomRightCorner<3, 3>().setZero();
    map.component.push_back(component);
    if (keyframe) {
      scan.keyframe = map.keyframes.size();
      const double step =
          map.keyframes.empty() ? 0.0 : (pose.translation() - map.T_map_keyframe.back().translation()).norm();
      const double path = map.keyframes.empty() ? 0.0 : map.keyframes.back().path_m + step;
      map.keyframes.push_back({map.keyframes.size(), scan.scan, component, pose, Matrix6d::Zero(), path, false});
      map.T_map_keyframe.push_back(pose);
      map.solution.component_of.push_back(component);
      map.solution.components[component].nodes.push_back(map.keyframes.size() - 1);
    }
    scans.push_back(scan);
  }

  /// A loop between two keyframes as the map has them.
  void add_loop(std::size_t source, std::size_t target, double p, bool accepted, const std::string& reason = "") {
    map_store::LoopRecord loop;
    loop.source = source;
    loop.target = target;
    loop.origin = "place";
    loop.answered = true;
    loop.p_correct = p;
    loop.T_target_source = map.T_map_keyframe[target].inverse() * map.T_map_keyframe[source];
    loop.evidence = {{"agreement", 0.8}, {"peak", 12.0}};
    loops.push_back(loop);
    mapping::LoopVerdict verdict;
    verdict.accepted = accepted;
    verdict.reason = reason;
    verdict.weight = accepted ? 1.0 : 0.0;
    verdict.chi2 = 2.0;
    verdict.edge = loops.size() - 1;
    map.loops.push_back(verdict);
  }
};

/// A cube of points, 0.5 m wide, around a place in the map.
inline void add_cube(PointCloud& cloud, const Pose& T_map_lidar, const Eigen::Vector3d& at) {
  for (int i = 0; i < 6 * 6 * 6; ++i) {
    const Eigen::Vector3d corner(i % 6, i / 6 % 6, i / 36);
    const Eigen::Vector3d in_map = at + 0.1 * (corner - Eigen::Vector3d::Constant(2.5));
    cloud.points.emplace_back((T_map_lidar.inverse() * in_map).cast<float>());
    cloud.intensity.push_back(static_cast<float>(i));
  }
}

/// Cubes at known places, seen from keyframes that look everywhere; a way out and back with one loop.
inline std::vector<Eigen::Vector3d> scene_cubes() {
  return {{10.0, 12.0, 1.0}, {30.0, -14.0, 2.0}, {50.0, 10.0, 0.0}, {0.0, -10.0, 3.0}};
}

inline SampleRun scene_run() {
  SampleRun run;
  run.name = "scene";
  for (int i = 0; i <= 40; ++i) {
    const double x = i <= 20 ? 3.0 * i : 3.0 * (40 - i);
    run.add_scan(pose_from_yaw(0.3 * i, {x, i <= 20 ? 0.0 : 2.0, 0.0}), i % 2 == 0);
  }
  run.add_loop(19, 1, 0.97, true);
  run.add_loop(12, 6, 0.88, false, "P(correct) below min_loop_p");
  const mapping::SolvedMap map = run.map;
  run.cloud = [map](std::size_t k) {
    PointCloud cloud;
    for (const Eigen::Vector3d& at : scene_cubes()) {
      add_cube(cloud, map.T_map_keyframe[k], at);
    }
    return cloud;
  };
  return run;
}

/// The scene with a drive that is looked for in it: right for four scans, lost for two, wrong for one.
inline SampleRun answered_run() {
  SampleRun run = scene_run();
  run.name = "answers";
  map_page::AnswerLayer layer{"Relocalization of a drive", {"searching", "tracking", "lost"}, {}};
  for (std::size_t i = 0; i < 7; ++i) {
    map_page::Answer answer;
    answer.name = "scan " + std::to_string(10 * i);
    answer.stamp_s = 50000.0 + static_cast<double>(i);
    answer.placed = i != 2 && i != 3;
    answer.kind = answer.placed ? 1 : 2;
    answer.truth = {5.0 * static_cast<double>(i), 1.0, 0.0};
    answer.position = answer.truth + Eigen::Vector3d(0.0, i == 5 ? 20.0 : 0.1, 0.0);
    answer.p_correct = answer.placed ? 0.9 : 0.2;
    answer.error_m = answer.placed ? (answer.position - answer.truth).norm() : std::nan("");
    answer.wrong = i == 5;
    answer.words = answer.placed ? "" : "too little fits";
    layer.answers.push_back(answer);
  }
  run.answers = layer;
  return run;
}

/// Streets of a town, up and down, 40 km with `loops` candidates between neighbouring streets.
inline SampleRun town_run(std::size_t scans, std::size_t loops, std::size_t points) {
  SampleRun run;
  run.name = "a town of long streets";
  for (std::size_t i = 0; i < scans; ++i) {
    const std::size_t street = i / 1000;
    const double along = static_cast<double>(i % 1000);
    const double x = street % 2 == 0 ? along : 1000.0 - along;
    run.add_scan(pose_from_yaw(street % 2 == 0 ? 0.0 : M_PI, {x, 12.0 * static_cast<double>(street), 0.0}), i % 4 == 0);
  }
  for (std::size_t i = 0; i < loops; ++i) {
    const std::size_t source = 250 + i * (run.map.keyframes.size() - 251) / std::max<std::size_t>(1, loops);
    const double p = static_cast<double>(i % 100) / 99.0;
    run.add_loop(source, source - 249, p, p >= 0.9, p >= 0.9 ? "" : "P(correct) below min_loop_p");
  }
  run.cloud = [points](std::size_t k) {
    PointCloud cloud;
    for (std::size_t i = 0; i < points; ++i) {
      const double angle = 2.399963 * static_cast<double>(i + k);  // the golden angle spreads them
      const double range = 2.0 + 40.0 * static_cast<double>(i) / static_cast<double>(points);
      cloud.points.emplace_back(static_cast<float>(range * std::cos(angle)),
                                static_cast<float>(range * std::sin(angle)),
                                static_cast<float>(i % 5 == 0 ? 0.05 * range : -1.8));
      cloud.intensity.push_back(static_cast<float>(i % 97));
    }
    return cloud;
  };
  return run;
}

/// Parts that nothing joins.
inline SampleRun parts_run(std::size_t parts) {
  SampleRun run;
  run.name = "a run in parts";
  for (std::size_t part = 0; part < parts; ++part) {
    for (std::size_t i = 0; i < 60 - 10 * part; ++i) {
      run.add_scan(pose_from_yaw(0.0, {2.0 * static_cast<double>(i), 0.0, 0.0}), i % 2 == 0, part);
    }
  }
  return run;
}

}  // namespace loopmark::testing_support

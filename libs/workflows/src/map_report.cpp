// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <nlohmann/json.hpp>

#include "loopmark/report/page.hpp"
#include "loopmark/report/plot.hpp"
#include "loopmark/report/table.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/map_run.hpp"
#include "part_tables.hpp"

namespace loopmark::workflows {
namespace {

using report::Page;
using report::Plot;
using report::Table;

std::string fixed(double value, int decimals) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

struct Path {
  std::vector<double> x, y, z;
};

Path path_of(const std::vector<Pose>& poses) {
  Path path;
  for (const Pose& pose : poses) {
    path.x.push_back(pose.translation().x());
    path.y.push_back(pose.translation().y());
    path.z.push_back(pose.translation().z());
  }
  return path;
}

std::vector<Pose> odometry_of(const std::vector<map_store::ScanRecord>& scans) {
  std::vector<Pose> poses;
  for (const map_store::ScanRecord& scan : scans) {
    poses.push_back(scan.T_segment_lidar);
  }
  return poses;
}

report::Plot trajectory_plot(const std::vector<map_store::ScanRecord>& scans,
                             const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map) {
  const Path odometry = path_of(odometry_of(scans));
  const Path solved = path_of(map.T_map_scan);
  report::Plot plot("Trajectory", "x [m]", "y [m]");
  plot.equal_axes();
  plot.line("odometry", odometry.x, odometry.y, {.dashed = true}).line("map", solved.x, solved.y);
  for (std::size_t i = 0; i < map.loops.size(); ++i) {
    if (map.loops[i].accepted) {
      const Eigen::Vector3d a = map.T_map_keyframe[loops[i].source].translation();
      const Eigen::Vector3d b = map.T_map_keyframe[loops[i].target].translation();
      plot.line("", {a.x(), b.x()}, {a.y(), b.y()}, {.colour = report::palette(3), .width = 1.0});
    }
  }
  return plot;
}

report::Plot against_scan(const std::string& title, const std::string& axis, const std::vector<double>& values) {
  std::vector<double> scans(values.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i] = static_cast<double>(i);
  }
  report::Plot plot(title, "scan", axis);
  plot.line("", scans, values);
  return plot;
}

/// How far the loops have moved each scan from where odometry alone put it.
report::Plot drift_plot(const std::vector<map_store::ScanRecord>& scans, const mapping::SolvedMap& map) {
  std::vector<double> moved;
  for (std::size_t i = 0; i < map.T_map_scan.size(); ++i) {
    moved.push_back((map.T_map_scan[i].translation() - scans[i].T_segment_lidar.translation()).norm());
  }
  return against_scan("Drift corrected", "moved by the loops [m]", moved);
}

report::Plot tracking_plot(const std::vector<map_store::ScanRecord>& scans) {
  std::vector<double> share;
  for (const map_store::ScanRecord& scan : scans) {
    share.push_back(scan.inlier_share);
  }
  return against_scan("Tracking", "share of points that fit the map", share);
}

report::Plot timing_plot(const MapTimes& t) {
  report::Plot plot("Time", "", "seconds");
  plot.categories({"reading", "odometry", "loops", "solving", "products"});
  plot.category_bars("", {t.reading, t.odometry, t.loops, t.solving, t.products});
  return plot;
}

report::Table loop_table(const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map) {
  report::Table table({"source scan", "target scan", "proposed by", "accepted", "P(correct)", "reason"});
  for (std::size_t i = 0; i < map.loops.size(); ++i) {
    const map_store::LoopRecord& loop = loops[i];
    table.row({report::count_cell(map.keyframes[loop.source].scan), report::count_cell(map.keyframes[loop.target].scan),
               loop.origin, map.loops[i].accepted ? "yes" : "no", report::number_cell(loop.p_correct, 3),
               map.loops[i].reason});
  }
  return table;
}

using Rows = std::vector<std::pair<std::string, std::string>>;

Rows rows(const MapSummary& s, const MapTimes& t) {
  Rows rows = {{"scans", std::to_string(s.scans) + " (" + std::to_string(s.damaged) + " damaged, " +
                             std::to_string(s.recovered) + " recovered)"},
               {"driven", fixed(s.path_m, 1) + " m in " + fixed(s.duration_s, 1) + " s"},
               {"scans were", s.compensation},
               {"keyframes", std::to_string(s.keyframes)},
               {"loops", std::to_string(s.loops) + " accepted of " + std::to_string(s.candidates) + " candidates"},
               {"components", internal::components_text(s.components)},
               {"time", fixed(t.whole, 1) + " s, " + fixed(static_cast<double>(s.scans) / t.whole, 1) + " scans/s, " +
                            fixed(s.duration_s / t.whole, 2) + " x real time"}};
  if (s.absolute) {
    const std::string of =
        s.components.size() > 1 ? " over " + std::to_string(s.absolute->poses) + " scans of main" : "";
    rows.push_back({"ATE", fixed(s.absolute->rmse_m, 3) + " m" + of + " (odometry alone " +
                               fixed(s.absolute_odometry->rmse_m, 3) + " m)"});
  }
  if (s.kitti) {
    rows.push_back({"t_err, r_err", s.kitti->segments == 0 ? "- (path below 100 m)"
                                                           : fixed(s.kitti->translation_percent, 3) + " %, " +
                                                                 fixed(s.kitti->rotation_deg_per_m, 5) + " deg/m"});
  }
  return rows;
}

}  // namespace

void write_map_report(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                      const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map,
                      const MapSummary& summary, const MapTimes& times, const std::vector<Pose>& truth) {
  report::Page page("Map", folder.name().string());
  page.facts(rows(summary, times));
  page.heading("Trajectory");
  report::Plot trajectory = trajectory_plot(scans, loops, map);
  page.plot(trajectory, truth.empty() ? "" : mapping::trajectory_error_definitions());
  if (!summary.drives.empty()) {
    page.heading("Drives").table(internal::drive_table(summary.drives));
  }
  if (!summary.inter_session_loops.empty()) {
    page.heading("Between drives").table(internal::inter_session_table(summary.inter_session_loops));
  }
  if (summary.components.size() > 1) {
    page.heading("Parts without a common frame").table(internal::component_table(summary.components));
  }
  page.heading("Drift and tracking").plots({drift_plot(scans, map), tracking_plot(scans)});
  page.heading("Loops").table(loop_table(loops, map));
  page.heading("Time").plot(timing_plot(times));
  storage::write_file_atomically(folder / "report.html", page.html());
}

void write_summary(const map_store::RunFolder& folder, const MapSummary& s, const MapTimes& t) {
  nlohmann::ordered_json json = {{"scans", s.scans},
                                 {"damaged", s.damaged},
                                 {"recovered", s.recovered},
                                 {"keyframes", s.keyframes},
                                 {"candidates", s.candidates},
                                 {"loops", s.loops},
                                 {"components", s.components.size()},
                                 {"path_m", s.path_m},
                                 {"duration_s", s.duration_s},
                                 {"compensation", s.compensation},
                                 {"damage", s.damage},
                                 {"parts", internal::components_json(s.components)}};
  if (!s.drives.empty()) {
    json["drives"] = internal::drives_json(s.drives);
    json["joints"] = internal::inter_session_json(s.inter_session_loops);
  }
  if (s.absolute) {
    json["ate_rmse_m"] = s.absolute->rmse_m;
    json["ate_odometry_rmse_m"] = s.absolute_odometry->rmse_m;
  }
  if (s.kitti && s.kitti->segments > 0) {
    json["t_err_percent"] = s.kitti->translation_percent;
    json["r_err_deg_per_m"] = s.kitti->rotation_deg_per_m;
  }
  storage::write_file_atomically(folder / "summary.json", json.dump(1) + "\n");
  const nlohmann::ordered_json seconds = {{"reading", t.reading}, {"odometry", t.odometry}, {"loops", t.loops},
                                          {"solving", t.solving}, {"products", t.products}, {"whole", t.whole}};
  storage::write_file_atomically(folder / "timings.json", seconds.dump(1) + "\n");
}

std::string closing_table(const MapOutcome& outcome) {
  std::string text;
  for (const auto& [key, value] : rows(outcome.summary, outcome.times)) {
    text += "  " + key + std::string(14 - std::min<std::size_t>(13, key.size()), ' ') + value + "\n";
  }
  if (outcome.summary.absolute) {
    text += "  " + mapping::trajectory_error_definitions() + "\n";
  }
  return text;
}

}  // namespace loopmark::workflows

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_report.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "loopmark/core/number_text.hpp"
#include "loopmark/io/point_files.hpp"
#include "loopmark/map_store/loop_decisions.hpp"
#include "loopmark/storage/files.hpp"
#include "part_tables.hpp"

namespace loopmark::workflows::internal {
namespace {

std::string fixed(double value, int decimals) { return format_text("%.*f", decimals, value); }

using Rows = std::vector<std::pair<std::string, std::string>>;

Rows rows(const MapSummary& s, const MapTimes& t) {
  Rows rows = {{"verdict", mapping::verdict_text(s.doubts)},
               {"scans", std::to_string(s.scans) + " (" + std::to_string(s.damaged) + " damaged, " +
                             std::to_string(s.recovered) + " recovered)"},
               {"driven", fixed(s.path_m, 1) + " m in " + fixed(s.duration_s, 1) + " s"},
               {"scans were", s.compensation},
               {"keyframes", std::to_string(s.keyframes)},
               {"loops", std::to_string(s.loops) + " accepted of " + std::to_string(s.candidates) + " candidates"},
               {"components", components_text(s.components)},
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

std::vector<map_page::PageTable> tables_of(const MapSummary& summary) {
  std::vector<map_page::PageTable> tables;
  if (!summary.drives.empty()) {
    tables.push_back(page_table("Drives", drive_table(summary.drives)));
  }
  if (!summary.inter_session_loops.empty()) {
    tables.push_back(page_table("Between drives", inter_session_table(summary.inter_session_loops)));
  }
  if (summary.components.size() > 1) {
    tables.push_back(page_table("Parts without a common frame", component_table(summary.components)));
  }
  return tables;
}

}  // namespace

map_page::PageTable page_table(const std::string& title, const report::Table& table) {
  map_page::PageTable result{title, table.columns(), {}};
  for (const std::vector<report::Cell>& row : table.rows()) {
    std::vector<std::string>& cells = result.rows.emplace_back();
    for (const report::Cell& cell : row) {
      cells.push_back(cell.text);
    }
  }
  return result;
}

map_page::MapPageInput map_page_input(const map_store::RunFolder& folder, const map_page::MapRecords& records,
                                      const MapSummary& summary, const MapTimes& times) {
  map_page::MapPageInput input{
      .name = folder.name().string(),
      .run = folder.name().string(),
      .facts = rows(summary, times),
      .note = summary.absolute ? mapping::trajectory_error_definitions() : "",
      .time_parts = {{"reading", times.reading},
                     {"odometry", times.odometry},
                     {"loops", times.loops},
                     {"solving", times.solving},
                     {"products", times.products}},
      .sessions = {},
      .tables = tables_of(summary),
      .edits = {},
      .records = records,
      .answers = {},
      .earlier_page = {},
      .keyframe_cloud = [&](std::size_t number) { return io::read_point_file(folder.keyframe(number, "pcd")).cloud; }};
  for (const DriveSummary& drive : summary.drives) {
    if (drive.belongs) {
      input.sessions.push_back({drive.name, drive.first_scan, drive.scans});
    }
  }
  return input;
}

}  // namespace loopmark::workflows::internal

namespace loopmark::workflows {

using namespace internal;  // NOLINT(google-build-using-namespace): the other half of this file

void write_map_report(const map_store::RunFolder& folder, const std::vector<map_store::ScanRecord>& scans,
                      const std::vector<map_store::LoopRecord>& loops, const mapping::SolvedMap& map,
                      const MapSummary& summary, const MapTimes& times, const std::vector<Pose>& truth,
                      double min_loop_p, const std::filesystem::path& earlier_page) {
  const std::vector<map_store::LoopDecision> decisions = map_store::read_loop_decisions(folder);
  map_page::MapPageInput input =
      map_page_input(folder, {scans, loops, map, decisions, truth, min_loop_p}, summary, times);
  input.earlier_page = earlier_page;
  const web_page::Document page = map_page::map_page(input);
  storage::write_file_atomically(folder / "report.html", [&](std::ostream& out) { page.write(out); });
}

namespace {

nlohmann::ordered_json doubts_json(const std::vector<mapping::MapDoubt>& doubts) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const mapping::MapDoubt& doubt : doubts) {
    list.push_back({{"reason", doubt.reason}, {"scans", doubt.scans}});
  }
  return list;
}

}  // namespace

void write_summary(const map_store::RunFolder& folder, const MapSummary& s, const MapTimes& t) {
  nlohmann::ordered_json json = {{"verdict", s.doubts.empty() ? "good" : "doubtful"},
                                 {"doubts", doubts_json(s.doubts)},
                                 {"scans", s.scans},
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
                                 {"parts", components_json(s.components)}};
  if (!s.drives.empty()) {
    json["drives"] = drives_json(s.drives);
    json["joints"] = inter_session_json(s.inter_session_loops);
  }
  if (s.absolute) {
    json["ate_rmse_m"] = s.absolute->rmse_m;
    json["ate_odometry_rmse_m"] = s.absolute_odometry->rmse_m;
  }
  if (s.kitti && s.kitti->segments > 0) {
    json["t_err_percent"] = s.kitti->translation_percent;
    json["r_err_deg_per_m"] = s.kitti->rotation_deg_per_m;
  }
  storage::write_file_atomically(folder / "summary.json",
                                 json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  const nlohmann::ordered_json seconds = {{"reading", t.reading}, {"odometry", t.odometry}, {"loops", t.loops},
                                          {"solving", t.solving}, {"products", t.products}, {"whole", t.whole}};
  storage::write_file_atomically(folder / "timings.json",
                                 seconds.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
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

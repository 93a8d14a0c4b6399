// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "part_tables.hpp"

#include <cstdio>

#include "loopmark/core/number_text.hpp"

namespace loopmark::workflows::internal {
namespace {

std::string metres(double value) { return format_text("%.1f m", value); }

}  // namespace

report::Table component_table(const std::vector<mapping::MapComponent>& components) {
  report::Table table({"component", "scans", "first", "last", "segments", "keyframes", "driven [m]",
                       "tried against others", "best P(correct)", "that pair"});
  for (const mapping::MapComponent& c : components) {
    table.row({c.name, report::count_cell(c.scans), report::count_cell(c.first_scan), report::count_cell(c.last_scan),
               report::count_cell(c.segments), report::count_cell(c.keyframes), report::number_cell(c.path_m, 1),
               report::count_cell(c.candidates), report::number_cell(c.best_p, 3), c.best});
  }
  return table;
}

report::Table drive_table(const std::vector<DriveSummary>& drives) {
  report::Table table(
      {"drive", "log", "belongs", "first scan", "scans", "keyframes", "in the map", "ATE alone [m]", "reason"});
  for (const DriveSummary& d : drives) {
    table.row({d.name, d.log, d.belongs ? "yes" : "no",
               d.belongs ? report::count_cell(d.first_scan) : report::Cell("-"), report::count_cell(d.scans),
               report::count_cell(d.keyframes), report::count_cell(d.in_map),
               d.absolute ? report::number_cell(d.absolute->rmse_m, 3) : report::Cell("-"), d.reason});
  }
  return table;
}

report::Table inter_session_table(const std::vector<InterSessionSummary>& inter_session_loops) {
  report::Table table({"drive", "drive", "places tried", "best P(correct)", "loops", "places compared", "alike"});
  for (const InterSessionSummary& j : inter_session_loops) {
    table.row({j.first, j.second, report::count_cell(j.candidates), report::number_cell(j.best_p, 3),
               report::count_cell(j.accepted), report::count_cell(j.checked), report::count_cell(j.agree)});
  }
  return table;
}

nlohmann::ordered_json drives_json(const std::vector<DriveSummary>& drives) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const DriveSummary& d : drives) {
    nlohmann::ordered_json drive = {{"name", d.name},
                                    {"log", d.log},
                                    {"belongs", d.belongs},
                                    {"first_scan", d.first_scan},
                                    {"scans", d.scans},
                                    {"keyframes", d.keyframes},
                                    {"keyframes_in_map", d.in_map},
                                    {"reason", d.reason}};
    if (d.absolute) {
      drive["ate_alone_rmse_m"] = d.absolute->rmse_m;
    }
    list.push_back(std::move(drive));
  }
  return list;
}

nlohmann::ordered_json inter_session_json(const std::vector<InterSessionSummary>& inter_session_loops) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const InterSessionSummary& j : inter_session_loops) {
    list.push_back({{"first", j.first},
                    {"second", j.second},
                    {"candidates", j.candidates},
                    {"best_p", j.best_p},
                    {"accepted", j.accepted},
                    {"checked", j.checked},
                    {"agree", j.agree}});
  }
  return list;
}

std::string components_text(const std::vector<mapping::MapComponent>& components) {
  std::string text = std::to_string(components.size());
  for (std::size_t c = 0; c < components.size() && components.size() > 1; ++c) {
    const mapping::MapComponent& part = components[c];
    text += (c == 0 ? " without a common frame: " : ", ") + part.name + " (" + std::to_string(part.scans) + " scans, " +
            std::to_string(part.first_scan) + "-" + std::to_string(part.last_scan) + ", " + metres(part.path_m) + ")";
  }
  return text;
}

nlohmann::ordered_json components_json(const std::vector<mapping::MapComponent>& components) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const mapping::MapComponent& c : components) {
    list.push_back({{"name", c.name},
                    {"anchored", c.anchored},
                    {"scans", c.scans},
                    {"first_scan", c.first_scan},
                    {"last_scan", c.last_scan},
                    {"segments", c.segments},
                    {"keyframes", c.keyframes},
                    {"path_m", c.path_m},
                    {"candidates_to_others", c.candidates},
                    {"best_p", c.best_p},
                    {"best", c.best}});
  }
  return list;
}

}  // namespace loopmark::workflows::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "loopmark/core/printable.hpp"
#include "loopmark/report/table.hpp"
#include "merge_text.hpp"

namespace loopmark::app {

void print_merge(const workflows::MergeOutcome& outcome) {
  const workflows::MapSummary& summary = outcome.map.summary;
  report::Table drives({"drive", "scans", "keyframes", "in the map", "ATE alone [m]"});
  for (const workflows::DriveSummary& d : summary.drives) {
    drives.row({d.name, report::count_cell(d.scans), report::count_cell(d.keyframes),
                d.belongs ? report::count_cell(d.in_map) : report::Cell("left out"),
                d.absolute ? report::number_cell(d.absolute->rmse_m, 3) : report::Cell("-")});
  }
  report::Table inter_session_loops({"between", "and", "places tried", "best P", "loops", "places compared", "alike"});
  for (const workflows::InterSessionSummary& j : summary.inter_session_loops) {
    inter_session_loops.row({j.first, j.second, report::count_cell(j.candidates), report::number_cell(j.best_p, 3),
                             report::count_cell(j.accepted), report::count_cell(j.checked),
                             report::count_cell(j.agree)});
  }
  std::printf("%s\n%s\n%s is whole:\n%s", drives.text().c_str(), inter_session_loops.text().c_str(),
              outcome.run.c_str(), workflows::closing_table(outcome.map).c_str());
  for (const std::string& warning : outcome.warnings) {
    std::fprintf(stderr, "warning: %s\n", printable(warning).c_str());
  }
}

}  // namespace loopmark::app

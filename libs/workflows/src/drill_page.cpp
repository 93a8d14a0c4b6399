// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "drill_page.hpp"

#include <cstdio>

#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/loops_run.hpp"
#include "map_report.hpp"

namespace loopmark::workflows::internal {
namespace {

std::string words_of(const kidnap_benchmark::DrillEvent& event, const kidnap_benchmark::DrillOutcome& outcome) {
  char text[160];
  std::snprintf(text, sizeof text, "%s, %s%s; %.1f s and %.1f m after the cut", name(event.disturbance),
                name(event.stratum), outcome.noticed ? ", the loss was noticed" : "", outcome.seconds,
                outcome.driven_m);
  return outcome.reason.empty() ? text : std::string(text) + "; " + outcome.reason;
}

map_page::Answer answer_of(const DrillResult& r, std::size_t i) {
  const kidnap_benchmark::DrillEvent& event = r.events[i];
  const kidnap_benchmark::DrillOutcome& outcome = r.outcomes[i];
  const kidnap_benchmark::DrillScan& arrival =
      (event.disturbance == kidnap_benchmark::Disturbance::kOtherDrive ? r.drive_scans : r.scans)[event.after];
  map_page::Answer answer;
  answer.name = "event " + std::to_string(event.number);
  answer.stamp_s = arrival.stamp_s;
  answer.kind = static_cast<std::size_t>(outcome.verdict);
  answer.placed = outcome.verdict != kidnap_benchmark::DrillVerdict::kNone;
  answer.p_correct = outcome.p_correct;
  answer.truth = arrival.T_map_lidar.translation();
  answer.wrong = outcome.verdict == kidnap_benchmark::DrillVerdict::kWrong;
  answer.words = words_of(event, outcome);
  if (answer.placed) {
    answer.position = outcome.T_map_answer.translation();
    answer.truth = outcome.T_map_truth.translation();
    answer.error_m = outcome.error.translation_m;
    answer.error_deg = outcome.error.rotation_deg;
  }
  return answer;
}

}  // namespace

void write_drill_page(const std::filesystem::path& folder, const std::filesystem::path& run, const DrillResult& result,
                      const std::vector<std::pair<std::string, std::string>>& facts, const std::string& note,
                      const std::vector<map_page::PageTable>& tables) {
  const OpenedRun opened = workflows::open_run(run);
  const mapping::SolvedMap map = opened.solve();
  const std::vector<Pose> none;
  map_page::MapPageInput input = workflows::internal::map_page_input(
      opened.folder, {opened.scans, opened.loops, map, opened.decisions, none, opened.options.slam.min_loop_p},
      workflows::summary_of(opened, map, none), MapTimes());
  input.name = result.run + (result.drive.empty() ? "" : ", and the drive " + result.drive);
  input.facts = facts;
  input.note = note;
  input.time_parts = {};  // the same bytes for the same drill
  input.tables = tables;
  input.answers = map_page::AnswerLayer{"Kidnap drill", {}, {}};
  for (const kidnap_benchmark::DrillVerdict verdict :
       {kidnap_benchmark::DrillVerdict::kRecovered, kidnap_benchmark::DrillVerdict::kWrong,
        kidnap_benchmark::DrillVerdict::kNone}) {
    input.answers->kinds.emplace_back(name(verdict));
  }
  for (std::size_t i = 0; i < result.events.size(); ++i) {
    input.answers->answers.push_back(answer_of(result, i));
  }
  const web_page::Document page = map_page::map_page(input);
  storage::write_file_atomically(folder / "report.html", [&](std::ostream& out) { page.write(out); });
}

}  // namespace loopmark::workflows::internal

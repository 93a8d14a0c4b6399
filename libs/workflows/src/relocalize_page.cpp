// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/relocalize_page.hpp"

#include <cstdio>

#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/loops_run.hpp"
#include "map_report.hpp"

namespace loopmark::workflows {
namespace {

map_page::Answer answer_of(const localization::RelocalizedScan& scan, const mapping::MapTruth* truth,
                           const std::vector<Pose>& true_query) {
  map_page::Answer answer;
  answer.name = "scan " + std::to_string(scan.scan);
  answer.stamp_s = scan.stamp_s;
  answer.kind = static_cast<std::size_t>(scan.state);
  answer.placed = scan.answered;
  answer.p_correct = scan.p_correct;
  answer.words = scan.reason;
  if (scan.answered) {
    answer.position = scan.T_map_lidar.translation();
    answer.sigma_m = map_page::position_sigma(scan.T_map_lidar, scan.covariance).norm();
  }
  if (truth != nullptr) {
    answer.truth = truth->in_map(true_query[scan.scan]).translation();
    if (scan.answered) {
      const PoseError error = truth->error(scan.T_map_lidar, true_query[scan.scan]);
      answer.error_m = error.translation_m;
      answer.error_deg = error.rotation_deg;
      answer.wrong = !localization::is_right(error);
    }
  }
  return answer;
}

std::vector<std::pair<std::string, std::string>> facts_of(const localization::RelocalizationSummary& s) {
  char first[48] = "none";
  if (s.first_answer_s >= 0.0) {
    std::snprintf(first, sizeof first, "after %.1f s of driving", s.first_answer_s);
  }
  std::vector<std::pair<std::string, std::string>> facts = {
      {"scans", std::to_string(s.scans)},
      {"placed", std::to_string(s.answered)},
      {"first answer", first},
      {"lost", std::to_string(s.losses) + " times, found again " + std::to_string(s.recoveries) + " times"}};
  if (s.judged > 0) {
    char median[48];
    std::snprintf(median, sizeof median, "%.2f m", s.median_error_m);
    facts.push_back({"wrong", std::to_string(s.wrong) + " of " + std::to_string(s.judged) + " (over 0.6 m or 5 deg)"});
    facts.push_back({"median error", median});
  }
  return facts;
}

}  // namespace

void write_relocalization_page(const std::filesystem::path& folder, const std::filesystem::path& run,
                               const std::string& log, const std::vector<localization::RelocalizedScan>& scans,
                               const localization::RelocalizationSummary& summary, const mapping::MapTruth* truth,
                               const std::vector<Pose>& true_query) {
  const OpenedRun opened = workflows::open_run(run);
  const mapping::SolvedMap map = opened.solve();
  const std::vector<Pose> none;
  map_page::MapPageInput input = workflows::internal::map_page_input(
      opened.folder, {opened.scans, opened.loops, map, opened.decisions, none, opened.options.slam.min_loop_p},
      workflows::summary_of(opened, map, none), workflows::times_of(opened));
  input.name = log + " in " + input.name;
  input.facts = facts_of(summary);
  input.time_parts = {};
  input.answers = map_page::AnswerLayer{"Relocalization", {}, {}};
  for (const localization::RelocalizationState state :
       {localization::RelocalizationState::kSearching, localization::RelocalizationState::kTracking,
        localization::RelocalizationState::kLost}) {
    input.answers->kinds.emplace_back(name(state));
  }
  for (const localization::RelocalizedScan& scan : scans) {
    input.answers->answers.push_back(answer_of(scan, truth, true_query));
  }
  const web_page::Document page = map_page::map_page(input);
  storage::write_file_atomically(folder / "report.html", [&](std::ostream& out) { page.write(out); });
}

}  // namespace loopmark::workflows

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_report.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "evaluate_plots.hpp"
#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/files.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/evaluation/result_tables.hpp"
#include "loopmark/report/page.hpp"

namespace loopmark::app {
namespace {

/// The number at the start of a cell ("97.06 %" -> 97.06), if the cell starts with one.
report::Cell cell_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && (end == text.data() + text.size() || *end == ' ');
  return number ? report::Cell(text, value) : report::Cell(text);
}

std::vector<const Outcome*> failures_of(const StoredResult& result, const std::string& algorithm) {
  std::vector<const Outcome*> failures;
  for (const Outcome& outcome : result.outcomes) {
    const bool accepted = outcome.negative && outcome.answer.status == AnswerStatus::kAnswered;
    if (outcome.algorithm == algorithm && (accepted || (!outcome.negative && !outcome.success))) {
      failures.push_back(&outcome);
    }
  }
  return failures;
}

report::Table failure_list(const StoredResult& result, const std::vector<const Outcome*>& failures) {
  report::Table table(
      {"Pair", "Frames", "Status", "TE (m)", "RE (deg)", "P(correct)", "Distance (m)", "Overlap", "Note"},
      "Failed pairs");
  for (const Outcome* outcome : failures) {
    const bool negative = outcome->negative;
    const RegistrationPair* pair = negative ? nullptr : &result.set.pairs[outcome->pair];
    table.row({report::count_cell(outcome->pair), to_string(result.set.key(outcome->pair)),
               negative ? "false accept" : to_string(outcome->answer.status),
               report::number_cell(outcome->error.translation_m, 2),
               report::number_cell(outcome->error.rotation_deg, 2), report::number_cell(outcome->answer.p_correct, 3),
               pair == nullptr ? report::Cell("-") : report::number_cell(pair->motion.head<3>().norm(), 1),
               pair == nullptr ? report::Cell("-") : report::number_cell(pair->overlap_symmetric, 2),
               outcome->answer.note});
  }
  return table;
}

/// Loads and draws one failed pair: what was answered beside what is true.
report::Image picture_of(const Outcome& outcome, const StoredResult& result, const ScanLoader& load,
                         const std::vector<Pose>& perturbations) {
  constexpr double kVoxelM = 0.4;
  constexpr std::size_t kWidth = 900;
  const PairKey& key = result.set.key(outcome.pair);
  PointCloud source = load(key.session, key.source);
  if (outcome.pair < perturbations.size()) {
    source = transformed(source, perturbations[outcome.pair]);
  }
  const auto from = voxel_downsampled(source, kVoxelM).points;
  const auto to = voxel_downsampled(load(key.target_session, key.target), kVoxelM).points;
  if (outcome.negative) {
    return report::registration_picture(from, to, outcome.answer.T_target_source, kWidth);
  }
  return report::failure_picture(from, to, outcome.answer.T_target_source,
                                 result.set.pairs[outcome.pair].T_target_source, kWidth);
}

std::string caption_of(const Outcome& outcome, const StoredResult& result) {
  char text[160];
  std::snprintf(text, sizeof text, "pair %zu: TE %.2f m, RE %.2f deg, P(correct) %.3f", outcome.pair,
                outcome.error.translation_m, outcome.error.rotation_deg, outcome.answer.p_correct);
  return std::string(text) + " (" + to_string(result.set.key(outcome.pair)) + ")";
}

void add_failures(report::Page& page, const StoredResult& result, const ScanLoader& load,
                  const std::vector<Pose>& perturbations, std::size_t pictures) {
  page.heading("Failures");
  for (const std::string& algorithm : result.experiment.algorithms) {
    const std::vector<const Outcome*> failures = failures_of(result, algorithm);
    report::Page body("");
    body.table(failure_list(result, failures));
    const std::size_t drawn = load ? std::min(pictures, failures.size()) : 0;
    std::vector<report::Image> images(drawn);
    parallel_for(drawn, [&](std::size_t i) { images[i] = picture_of(*failures[i], result, load, perturbations); });
    for (std::size_t i = 0; i < drawn; ++i) {
      body.picture(images[i], caption_of(*failures[i], result));
    }
    if (drawn < failures.size()) {
      body.paragraph(std::to_string(failures.size() - drawn) + " more without a picture" +
                     (load ? " (--pictures N draws more)." : " (no scans were given: --data)."));
    }
    page.details(algorithm + ": " + std::to_string(failures.size()) + " failed pairs", body);
  }
}

void add_plots(report::Page& page, const StoredResult& result, const std::vector<AlgorithmSummary>& summaries) {
  page.heading("Recall");
  page.plots({recall_plot(summaries, "Recall by overlap", "symmetric overlap", &AlgorithmSummary::by_overlap),
              recall_plot(summaries, "Recall by distance", "distance [m]", &AlgorithmSummary::by_distance)});
  page.plots({recall_plot(summaries, "Recall by yaw", "|yaw| [deg]", &AlgorithmSummary::by_yaw), time_plot(summaries)});
  page.heading("Errors");
  page.plots({error_plot(result, false), error_plot(result, true)});
  if (std::any_of(summaries.begin(), summaries.end(), [](const auto& s) { return s.has_scores; })) {
    page.heading("Certainty");
    page.plots({precision_recall_plot(summaries), reliability_plot(summaries)});
  }
}

}  // namespace

report::Table report_table(const TextTable& table) {
  report::Table out(table.columns, table.caption);
  for (const auto& row : table.rows) {
    std::vector<report::Cell> cells;
    std::transform(row.begin(), row.end(), std::back_inserter(cells), cell_of);
    out.row(std::move(cells));
  }
  return out;
}

void write_evaluation_report(const std::filesystem::path& folder, const StoredResult& result, const ScanLoader& load,
                             const std::vector<Pose>& perturbations, std::size_t pictures) {
  const auto summaries = summarise_all(result.outcomes, result.experiment.algorithms, result.set);
  const auto tests = paired_tests(result.outcomes, result.experiment.algorithms);
  report::Page page("Registration on " + result.experiment.set_name,
                    std::to_string(result.experiment.pairs) + " pairs, " + std::to_string(result.experiment.negatives) +
                        " negatives; right below " + fixed(result.experiment.criterion.max_rotation_deg, 1) +
                        " deg and " + fixed(result.experiment.criterion.max_translation_m, 2) + " m");
  const auto tables = result_tables(result, summaries, tests);
  page.heading("Overview").table(report_table(tables.front())).paragraph(tables.front().note);
  add_plots(page, result, summaries);
  page.heading("Tables");
  for (std::size_t i = 1; i < tables.size(); ++i) {
    page.table(report_table(tables[i]));
    if (!tables[i].note.empty()) {
      page.paragraph(tables[i].note);
    }
  }
  add_failures(page, result, load, perturbations, pictures);
  write_file_atomically(folder / "report.html", page.html());
}

}  // namespace loopmark::app

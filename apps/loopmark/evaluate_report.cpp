// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_report.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "evaluate_failures.hpp"
#include "evaluate_plots.hpp"
#include "loopmark/evaluation/result_tables.hpp"
#include "loopmark/report/page.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::app {
namespace {

/// The number at the start of a cell ("97.06 %" -> 97.06), if the cell starts with one.
report::Cell cell_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && (end == text.data() + text.size() || *end == ' ');
  return number ? report::Cell(text, value) : report::Cell(text);
}

/// The algorithms whose curves are drawn: those of highest recall, in the order of the result.
std::vector<evaluation::AlgorithmSummary> drawn_ones(const std::vector<evaluation::AlgorithmSummary>& summaries) {
  constexpr std::size_t kMost = 8;
  std::vector<std::size_t> order(summaries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return summaries[a].recall() > summaries[b].recall(); });
  order.resize(std::min(kMost, order.size()));
  std::sort(order.begin(), order.end());
  std::vector<evaluation::AlgorithmSummary> drawn;
  for (const std::size_t i : order) {
    drawn.push_back(summaries[i]);
  }
  return drawn;
}

void add_plots(report::Page& page, const evaluation::StoredResult& result,
               const std::vector<evaluation::AlgorithmSummary>& all) {
  const std::vector<evaluation::AlgorithmSummary> summaries = drawn_ones(all);
  page.heading("Recall");
  if (summaries.size() < all.size()) {
    page.paragraph("Drawn are the " + std::to_string(summaries.size()) +
                   " algorithms of highest recall; the tables have all " + std::to_string(all.size()) + ".");
  }
  page.plots(
      {recall_plot(summaries, "Recall by overlap", "symmetric overlap", &evaluation::AlgorithmSummary::by_overlap),
       recall_plot(summaries, "Recall by distance", "distance [m]", &evaluation::AlgorithmSummary::by_distance)});
  page.plots({recall_plot(summaries, "Recall by yaw", "|yaw| [deg]", &evaluation::AlgorithmSummary::by_yaw),
              time_plot(summaries)});
  page.heading("Errors");
  page.plots({error_plot(result, summaries, false), error_plot(result, summaries, true)});
  if (std::any_of(summaries.begin(), summaries.end(), [](const auto& s) { return s.has_scores; })) {
    page.heading("Certainty");
    page.plots({precision_recall_plot(summaries), reliability_plot(summaries)});
  }
}

}  // namespace

report::Table report_table(const text::TextTable& table) {
  report::Table out(table.columns, table.caption);
  for (const auto& row : table.rows) {
    std::vector<report::Cell> cells;
    std::transform(row.begin(), row.end(), std::back_inserter(cells), cell_of);
    out.row(std::move(cells));
  }
  return out;
}

void write_evaluation_report(const std::filesystem::path& folder, const evaluation::StoredResult& result,
                             const evaluation::ScanLoader& load, const std::vector<Pose>& perturbations,
                             std::size_t pictures) {
  const auto summaries = evaluation::summarise_all(result.outcomes, result.experiment.algorithms, result.set);
  const auto tests = evaluation::paired_tests(result.outcomes, result.experiment.algorithms);
  report::Page page("Registration on " + result.experiment.set_name,
                    std::to_string(result.experiment.pairs) + " pairs, " + std::to_string(result.experiment.negatives) +
                        " negatives; right below " + text::fixed(result.experiment.criterion.max_rotation_deg, 1) +
                        " deg and " + text::fixed(result.experiment.criterion.max_translation_m, 2) + " m");
  const auto tables = evaluation::result_tables(result, summaries, tests);
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
  storage::write_file_atomically(folder / "report.html", page.html());
}

}  // namespace loopmark::app

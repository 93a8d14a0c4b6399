// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "evaluate_paper.hpp"
#include "evaluate_report.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/result_tables.hpp"
#include "loopmark/report/page.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;

/// Both results in one, the algorithms marked by where they come from.
evaluation::StoredResult side_by_side(const CompareArguments& a) {
  evaluation::StoredResult joined = evaluation::read_result(a.first);
  const evaluation::StoredResult second = evaluation::read_result(a.second);
  if (!joined.experiment.same_task(second.experiment)) {
    throw InputError(a.second.string(), "", "another set or criterion than " + a.first.string(),
                     "only results of the same pairs can be compared");
  }
  const auto mark = [](std::string& name, const char* letter) { name = std::string(letter) + ": " + name; };
  for (std::string& name : joined.experiment.algorithms) {
    mark(name, "A");
  }
  for (evaluation::Outcome& outcome : joined.outcomes) {
    mark(outcome.algorithm, "A");
  }
  for (std::string name : second.experiment.algorithms) {
    mark(name, "B");
    joined.experiment.algorithms.push_back(name);
  }
  for (evaluation::Outcome outcome : second.outcomes) {
    mark(outcome.algorithm, "B");
    joined.outcomes.push_back(std::move(outcome));
  }
  return joined;
}

/// One row a pair, with success and errors of every algorithm.
text::TextTable pair_table(const evaluation::StoredResult& joined) {
  text::TextTable table{"compare", "Pair by pair", {"Pair", "Frames"}, {}, ""};
  for (std::size_t i = 0; i < joined.set.size(); ++i) {
    table.rows.push_back({std::to_string(i), to_string(joined.set.key(i))});
  }
  for (const std::string& name : joined.experiment.algorithms) {
    table.columns.insert(table.columns.end(), {name, "TE (m)", "RE (deg)"});
  }
  for (const evaluation::Outcome& outcome : joined.outcomes) {
    auto& row = table.rows.at(outcome.pair);
    const std::string verdict = outcome.negative  ? to_string(outcome.answer.status)
                                : outcome.success ? "right"
                                                  : "wrong";
    row.insert(row.end(),
               {verdict, text::fixed(outcome.error.translation_m, 3), text::fixed(outcome.error.rotation_deg, 3)});
  }
  return table;
}

std::string csv_of(const text::TextTable& table) { return report_table(table).csv(); }

/// Prints the pairs on which algorithms disagree.
void print_disagreements(const evaluation::StoredResult& joined, const text::TextTable& table) {
  std::size_t differing = 0;
  for (const auto& row : table.rows) {
    bool differs = false;
    for (std::size_t c = 5; c < row.size(); c += 3) {
      differs = differs || row[c] != row[2];
    }
    if (differs && ++differing <= 20) {
      std::printf("pair %s (%s):", row[0].c_str(), row[1].c_str());
      for (std::size_t c = 2; c < row.size(); c += 3) {
        std::printf(" %s %s;", joined.experiment.algorithms[(c - 2) / 3].c_str(), row[c].c_str());
      }
      std::printf("\n");
    }
  }
  std::printf("%zu of %zu pairs with different outcomes\n", differing, table.rows.size());
}

}  // namespace

int compare_results(const CompareArguments& a) {
  const evaluation::StoredResult joined = side_by_side(a);
  const auto summaries = evaluation::summarise_all(joined.outcomes, joined.experiment.algorithms, joined.set);
  const text::TextTable overview = evaluation::overview_table(joined.experiment, summaries);
  const text::TextTable tests =
      evaluation::paired_table(evaluation::paired_tests(joined.outcomes, joined.experiment.algorithms));
  const text::TextTable pairs = pair_table(joined);
  std::printf("A: %s\nB: %s\n\n%s\n%s\n", a.first.c_str(), a.second.c_str(), text::to_markdown(overview).c_str(),
              text::to_markdown(tests).c_str());
  print_disagreements(joined, pairs);
  if (!a.output.empty()) {
    fs::create_directories(a.output);
    storage::write_file_atomically(a.output / "compare.csv", csv_of(pairs));
    report::Page page("Two results side by side", "A: " + a.first.string() + "; B: " + a.second.string());
    page.table(report_table(overview)).table(report_table(tests)).table(report_table(pairs));
    storage::write_file_atomically(a.output / "compare.html", page.html());
  }
  return 0;
}

}  // namespace loopmark::app

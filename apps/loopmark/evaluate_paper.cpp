// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_paper.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>

#include "evaluate_report.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/paper_tables.hpp"
#include "loopmark/pair_sets/set_statistics.hpp"
#include "loopmark/report/page.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;

/// A table and the plots that go with it.
struct Figure {
  text::TextTable table;
  std::vector<report::Plot> plots;
};

/// "NAME=PATH", or PATH named after itself.
std::pair<std::string, std::string> named_input(const std::string& text) {
  const std::size_t equals = text.find('=');
  return equals == std::string::npos ? std::pair{fs::path(text).stem().string(), text}
                                     : std::pair{text.substr(0, equals), text.substr(equals + 1)};
}

evaluation::StoredResult first_result(const PaperArguments& a) { return evaluation::read_result(a.inputs.front()); }

std::vector<evaluation::DomainResult> domain_results(const PaperArguments& a) {
  std::vector<evaluation::DomainResult> results;
  for (const std::string& input : a.inputs) {
    const auto [name, path] = named_input(input);
    const std::size_t colon = name.find(':');
    const std::string train = colon == std::string::npos ? "-" : name.substr(colon + 1);
    for (evaluation::DomainResult& domain :
         evaluation::split_by_domain(name.substr(0, colon), train, evaluation::read_result(path))) {
      results.push_back(std::move(domain));
    }
  }
  return results;
}

std::vector<double> as_doubles(const std::vector<std::size_t>& counts) { return {counts.begin(), counts.end()}; }

Figure sets_figure(const PaperArguments& a) {
  std::vector<std::pair<std::string, std::vector<pair_sets::RegistrationPair>>> sets;
  for (const std::string& input : a.inputs) {
    const auto [name, path] = named_input(input);
    sets.emplace_back(name, pair_sets::read_pair_set(path));
  }
  Figure figure{evaluation::paper_sets_table(sets), {}};
  for (const pair_sets::PairQuantity& quantity : pair_sets::pair_quantities()) {
    report::Plot plot(quantity.name, quantity.name, "pairs [%]");
    plot.size(420, 260);
    for (const auto& [name, pairs] : sets) {
      std::vector<double> shares = as_doubles(pair_sets::counts_in_bins(pairs, quantity));
      for (double& share : shares) {
        share *= 100.0 / static_cast<double>(pairs.size());
      }
      report::Style style;
      style.opacity = 0.5;
      plot.bars(name, quantity.edges, shares, style);
    }
    figure.plots.push_back(plot);
  }
  return figure;
}

Figure failures_figure(const PaperArguments& a) {
  const evaluation::StoredResult result = first_result(a);
  const std::string algorithm = a.algorithm.empty() ? result.experiment.algorithms.front() : a.algorithm;
  Figure figure{evaluation::paper_failures_table(result, algorithm), {}};
  for (const evaluation::FailureHistogram& histogram : evaluation::failure_histograms(result, algorithm)) {
    std::vector<double> all(histogram.successes.size());
    std::vector<double> ratio(histogram.successes.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = static_cast<double>(histogram.successes[i] + histogram.failures[i]);
      ratio[i] = all[i] > 0.0 ? 100.0 * static_cast<double>(histogram.failures[i]) / all[i] : 0.0;
    }
    report::Plot counts(histogram.quantity, histogram.quantity, "pairs");
    counts.size(420, 260)
        .bars("all", histogram.edges, all)
        .bars("failed", histogram.edges, as_doubles(histogram.failures));
    report::Plot ratios(histogram.quantity + ": failed", histogram.quantity, "failed [%]");
    ratios.size(420, 260).bars("", histogram.edges, ratio);
    figure.plots.push_back(counts);
    figure.plots.push_back(ratios);
  }
  return figure;
}

/// Recall against time of the variants with, or without, a refinement, as the paper draws them side by side.
std::optional<report::Plot> hulls_plot(const std::vector<evaluation::Variant>& variants, bool refined) {
  report::Plot plot(refined ? "With refinement: hulls of repeated runs" : "Algorithm only: hulls of repeated runs",
                    "mean seconds a pair, the paper's accounting", "recall [%]");
  plot.size(560, 420);
  std::size_t colour = 0;
  for (const evaluation::Variant& variant : variants) {
    if ((variant.name.find('+') != std::string::npos) != refined) {
      continue;
    }
    std::vector<double> x, y;
    for (const evaluation::RunPoint& point : variant.hull) {
      x.push_back(point.seconds);
      y.push_back(100.0 * point.recall);
    }
    report::Style style;
    style.colour = report::palette(colour++);
    style.opacity = 0.35;
    if (x.size() > 2) {
      plot.polygon("", x, y, style);
    }
    style.opacity = 1.0;
    style.radius = 5.0;
    plot.points(variant.name, {variant.mean.seconds}, {100.0 * variant.mean.recall}, style);
  }
  return colour == 0 ? std::nullopt : std::optional(plot);
}

Figure ablation_figure(const PaperArguments& a) {
  const evaluation::StoredResult result = first_result(a);
  Figure figure{evaluation::paper_ablation_table(result), {}};
  for (const bool refined : {false, true}) {
    if (const auto plot = hulls_plot(evaluation::variants_of(result), refined)) {
      figure.plots.push_back(*plot);
    }
  }
  return figure;
}

using Maker = std::function<Figure(const PaperArguments&)>;

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> table = {
      {"evaluation",
       [](const PaperArguments& a) {
         return Figure{evaluation::paper_evaluation_table(first_result(a), false), {}};
       }},
      {"cross-domain",
       [](const PaperArguments& a) {
         return Figure{evaluation::paper_evaluation_table(first_result(a), true), {}};
       }},
      {"matrix",
       [](const PaperArguments& a) {
         return Figure{evaluation::paper_matrix_table(domain_results(a)), {}};
       }},
      {"running-times",
       [](const PaperArguments& a) {
         return Figure{evaluation::paper_times_table(domain_results(a)), {}};
       }},
      {"match-sizes",
       [](const PaperArguments& a) {
         return Figure{evaluation::paper_match_sizes_table(domain_results(a)), {}};
       }},
      {"refinement",
       [](const PaperArguments& a) {
         return Figure{evaluation::paper_refinement_table(first_result(a)), {}};
       }},
      {"ransac-ablation", ablation_figure},
      {"gpf-ablation", ablation_figure},
      {"sets", sets_figure},
      {"failures", failures_figure}};
  return table;
}

void write_figure(const fs::path& folder, const std::string& name, const Figure& figure) {
  fs::create_directories(folder);
  storage::write_file_atomically(folder / (name + ".md"), text::to_markdown(figure.table));
  storage::write_file_atomically(folder / (name + ".tex"), text::to_latex(figure.table));
  report::Page page(figure.table.caption);
  page.table(report_table(figure.table)).paragraph(figure.table.note);
  for (std::size_t i = 0; i < figure.plots.size(); i += 2) {
    page.plots({figure.plots.begin() + static_cast<std::ptrdiff_t>(i),
                figure.plots.begin() + static_cast<std::ptrdiff_t>(std::min(i + 2, figure.plots.size()))});
  }
  storage::write_file_atomically(folder / (name + ".html"), page.html());
}

}  // namespace

std::vector<std::string> paper_table_names() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : makers()) {
    names.push_back(name);
  }
  return names;
}

int print_paper_table(const PaperArguments& a) {
  const auto maker = std::find_if(makers().begin(), makers().end(), [&](const auto& m) { return m.first == a.table; });
  if (maker == makers().end()) {
    throw InputError("no table of the paper is called " + a.table);
  }
  const Figure figure = maker->second(a);
  std::printf("%s", text::to_markdown(figure.table).c_str());
  if (!a.output.empty()) {
    write_figure(a.output, a.table, figure);
    std::printf("\nwritten to %s (%s.md, .tex, .html)\n", a.output.c_str(), a.table.c_str());
  }
  return 0;
}

}  // namespace loopmark::app

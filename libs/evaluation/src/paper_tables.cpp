// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/paper_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/paper_numbers.hpp"
#include "loopmark/pair_sets/set_statistics.hpp"

namespace loopmark::evaluation {
namespace {

constexpr const char* kTheirs =
    "Rows marked (paper) are the paper's own numbers: learned features (FCGF) matched, their sets and machines. Times "
    "are means in the paper's accounting: without downsampling, features and the search for the first nearest "
    "neighbour.";

const AlgorithmSummary* find(const std::vector<AlgorithmSummary>& summaries, const std::string& name) {
  const auto at = std::find_if(summaries.begin(), summaries.end(), [&](const auto& s) { return s.name == name; });
  return at == summaries.end() ? nullptr : &*at;
}

std::vector<AlgorithmSummary> summaries_of(const StoredResult& result) {
  return summarise_all(result.outcomes, result.experiment.algorithms, result.set);
}

std::string share_cell(const AlgorithmSummary* s) { return s == nullptr ? "-" : text::percent(s->recall()); }
std::string time_cell(const AlgorithmSummary* s) { return s == nullptr ? "-" : text::fixed(s->paper_seconds.mean, 3); }

/// The mean of a named number, over all algorithms that have it.
double mean_number(const std::vector<AlgorithmSummary>& summaries, const std::string& name) {
  for (const AlgorithmSummary& summary : summaries) {
    for (const auto& [key, value] : summary.number_means) {
      if (key == name) {
        return value;
      }
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Algorithm names of all results, each once, in order.
std::vector<std::string> all_algorithms(const std::vector<DomainResult>& results) {
  std::vector<std::string> names;
  for (const DomainResult& domain : results) {
    for (const std::string& name : domain.result.experiment.algorithms) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  return names;
}

/// The layout of the 3 x 3 tables: ours first, then the paper's with its own columns.
text::TextTable domain_table(const std::string& name, const std::string& caption,
                             const std::vector<DomainResult>& results, std::string (*ours)(const AlgorithmSummary*),
                             std::vector<double> paper::DomainRow::*theirs, int decimals) {
  const std::vector<std::string> algorithms = all_algorithms(results);
  text::TextTable table{name, caption, {"Test", "Train"}, {}, kTheirs};
  table.columns.insert(table.columns.end(), algorithms.begin(), algorithms.end());
  for (const std::string& algorithm : paper::domain_algorithms()) {
    table.columns.push_back(algorithm + " (paper)");
  }
  const std::size_t width = paper::domain_algorithms().size();
  for (const DomainResult& domain : results) {
    const auto summaries = summaries_of(domain.result);
    std::vector<std::string> row = {domain.test, domain.train};
    for (const std::string& algorithm : algorithms) {
      row.push_back(ours(find(summaries, algorithm)));
    }
    row.insert(row.end(), width, "-");
    table.rows.push_back(std::move(row));
  }
  for (const paper::DomainRow& domain : paper::domains()) {
    std::vector<std::string> row = {domain.test + " (paper)", domain.train};
    row.insert(row.end(), algorithms.size(), "-");
    for (const double value : domain.*theirs) {
      row.push_back(text::fixed(value, decimals));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

double cross(const RunPoint& o, const RunPoint& a, const RunPoint& b) {
  return (a.seconds - o.seconds) * (b.recall - o.recall) - (a.recall - o.recall) * (b.seconds - o.seconds);
}

/// "ransac_gpf@Boston+icp" -> {"ransac_gpf+icp", "Boston"}.
std::pair<std::string, std::string> without_domain(const std::string& name, const std::string& otherwise) {
  const std::size_t at = name.find('@');
  if (at == std::string::npos) {
    return {name, otherwise};
  }
  const std::size_t end = std::min(name.find('+', at), name.size());
  return {name.substr(0, at) + name.substr(end), name.substr(at + 1, end - at - 1)};
}

}  // namespace

std::vector<DomainResult> split_by_domain(const std::string& test, const std::string& train,
                                          const StoredResult& result) {
  std::vector<DomainResult> domains;
  const auto domain_of = [&](const std::string& name) -> StoredResult& {
    const auto found = std::find_if(domains.begin(), domains.end(), [&](const auto& d) { return d.train == name; });
    if (found != domains.end()) {
      return found->result;
    }
    domains.push_back({test, name, {result.experiment, result.set, {}}});
    domains.back().result.experiment.algorithms.clear();
    return domains.back().result;
  };
  for (const std::string& algorithm : result.experiment.algorithms) {
    const auto [name, domain] = without_domain(algorithm, train);
    domain_of(domain).experiment.algorithms.push_back(name);
  }
  for (Outcome outcome : result.outcomes) {
    const auto [name, domain] = without_domain(outcome.algorithm, train);
    outcome.algorithm = name;
    domain_of(domain).outcomes.push_back(std::move(outcome));
  }
  return domains;
}

text::TextTable paper_evaluation_table(const StoredResult& result, bool cross_domain) {
  text::TextTable table{
      cross_domain ? "cross_domain" : "evaluation",
      std::string(cross_domain ? "Cross-domain evaluation" : "Evaluation of registration algorithms") + " on " +
          result.experiment.set_name,
      {"Algorithm", "Recall, algo. only", "Time (s)", "Recall, with ICP", "Time (s)"},
      {},
      kTheirs};
  const auto summaries = summaries_of(result);
  for (const AlgorithmSummary& summary : summaries) {
    if (summary.name.find('+') == std::string::npos) {
      const AlgorithmSummary* refined = find(summaries, summary.name + "+icp");
      table.rows.push_back(
          {summary.name, share_cell(&summary), time_cell(&summary), share_cell(refined), time_cell(refined)});
    }
  }
  for (const paper::EvaluationRow& row : cross_domain ? paper::cross_domain() : paper::evaluation()) {
    table.rows.push_back({row.algorithm + " (paper, NuScenes-Boston)", text::fixed(row.recall, 2) + " %",
                          text::fixed(row.seconds, 3), text::fixed(row.recall_icp, 2) + " %",
                          text::fixed(row.seconds_icp, 3)});
  }
  return table;
}

text::TextTable paper_matrix_table(const std::vector<DomainResult>& results) {
  return domain_table("matrix", "Recall (%) by test and train domain", results, share_cell, &paper::DomainRow::recall,
                      2);
}

text::TextTable paper_times_table(const std::vector<DomainResult>& results) {
  return domain_table("running_times", "Seconds a pair by test and train domain", results, time_cell,
                      &paper::DomainRow::seconds, 3);
}

text::TextTable paper_match_sizes_table(const std::vector<DomainResult>& results) {
  text::TextTable table{"match_sizes",
                        "Pair-match set sizes (means)",
                        {"Test", "Train", "Initial", "MNN-filtered"},
                        {},
                        "Rows marked (paper) are the paper's own numbers, of FCGF features."};
  for (const DomainResult& domain : results) {
    const auto summaries = summaries_of(domain.result);
    table.rows.push_back({domain.test, domain.train, text::fixed(mean_number(summaries, "matches_initial"), 0),
                          text::fixed(mean_number(summaries, "matches_mutual"), 0)});
  }
  for (const paper::DomainRow& row : paper::domains()) {
    table.rows.push_back(
        {row.test + " (paper)", row.train, text::fixed(row.matches, 0), text::fixed(row.mutual_matches, 0)});
  }
  return table;
}

text::TextTable paper_refinement_table(const StoredResult& result) {
  text::TextTable table{
      "refinement",
      "Refinement experiment on " + result.experiment.set_name,
      {"Algorithm", "Recall", "TE mean (cm)", "TE 50 %", "TE 95 %", "RE mean (deg)", "RE 50 %", "RE 95 %"},
      {},
      "Over all pairs. Rows marked (paper) are the paper's own numbers, on Apollo-Southbay-Balanced from "
      "its coarse motions."};
  for (const AlgorithmSummary& s : summaries_of(result)) {
    table.rows.push_back({s.name, text::percent(s.recall()), text::fixed(100.0 * s.te_m.mean, 2),
                          text::fixed(100.0 * s.te_m.median, 2), text::fixed(100.0 * s.te_m.p95, 2),
                          text::fixed(s.re_deg.mean, 2), text::fixed(s.re_deg.median, 2),
                          text::fixed(s.re_deg.p95, 2)});
  }
  for (const paper::RefinementRow& row : paper::refinement()) {
    table.rows.push_back({row.algorithm + " (paper)", text::fixed(row.recall, 2) + " %", text::fixed(row.te_cm[0], 2),
                          text::fixed(row.te_cm[1], 2), text::fixed(row.te_cm[2], 2), text::fixed(row.re_deg[0], 2),
                          text::fixed(row.re_deg[1], 2), text::fixed(row.re_deg[2], 2)});
  }
  return table;
}

text::TextTable paper_sets_table(
    const std::vector<std::pair<std::string, std::vector<pair_sets::RegistrationPair>>>& sets) {
  text::TextTable table = pair_sets::set_overview(sets);
  table.note = "The paper's sets have (train / validation / test):";
  for (const paper::SetSizes& sizes : paper::set_sizes()) {
    table.note += " " + sizes.set + " " + std::to_string(sizes.train) + " / " + std::to_string(sizes.validation) +
                  " / " + std::to_string(sizes.test) + ";";
  }
  table.note.back() = '.';
  return table;
}

std::vector<RunPoint> convex_hull(std::vector<RunPoint> points) {
  const auto less = [](const RunPoint& a, const RunPoint& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.recall < b.recall;
  };
  const auto same = [](const RunPoint& a, const RunPoint& b) { return a.seconds == b.seconds && a.recall == b.recall; };
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) {
    return points;
  }
  std::vector<RunPoint> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const RunPoint& point : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<Variant> variants_of(const StoredResult& result) {
  std::vector<Variant> variants;
  for (const AlgorithmSummary& summary : summaries_of(result)) {
    // "NAME#2+icp" is the second run of "NAME+icp".
    std::string name = summary.name;
    const std::size_t mark = name.find('#');
    if (mark != std::string::npos) {
      name.erase(mark, name.find_first_not_of("0123456789", mark + 1) - mark);
    }
    auto at = std::find_if(variants.begin(), variants.end(), [&](const Variant& v) { return v.name == name; });
    if (at == variants.end()) {
      at = variants.insert(variants.end(), {name, {}, {}, {}});
    }
    at->runs.push_back({summary.paper_seconds.mean, summary.recall()});
  }
  for (Variant& variant : variants) {
    const double count = static_cast<double>(variant.runs.size());
    for (const RunPoint& run : variant.runs) {
      variant.mean.seconds += run.seconds / count;
      variant.mean.recall += run.recall / count;
    }
    variant.hull = convex_hull(variant.runs);
  }
  return variants;
}

text::TextTable paper_ablation_table(const StoredResult& result) {
  text::TextTable table{"ablation",
                        "Ablation on " + result.experiment.set_name,
                        {"Variant", "Runs", "Recall, mean", "lowest", "highest", "Time (s), mean", "lowest", "highest"},
                        {},
                        "The paper shows its ablations as figures only: PROSAC with ELC is best there, LO above GC."};
  for (const Variant& variant : variants_of(result)) {
    const auto [slow, fast] = std::minmax_element(variant.runs.begin(), variant.runs.end(),
                                                  [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    const auto [low, high] = std::minmax_element(variant.runs.begin(), variant.runs.end(),
                                                 [](const auto& a, const auto& b) { return a.recall < b.recall; });
    table.rows.push_back({variant.name, std::to_string(variant.runs.size()), text::percent(variant.mean.recall),
                          text::percent(low->recall), text::percent(high->recall), text::fixed(variant.mean.seconds, 4),
                          text::fixed(slow->seconds, 4), text::fixed(fast->seconds, 4)});
  }
  return table;
}

std::vector<FailureHistogram> failure_histograms(const StoredResult& result, const std::string& algorithm) {
  std::vector<pair_sets::RegistrationPair> successes, failures;
  for (const Outcome& outcome : result.outcomes) {
    if (outcome.algorithm == algorithm && !outcome.negative) {
      (outcome.success ? successes : failures).push_back(result.set.pairs[outcome.pair]);
    }
  }
  if (successes.empty() && failures.empty()) {
    throw InputError("no algorithm " + algorithm + " in this result");
  }
  std::vector<FailureHistogram> histograms;
  for (const pair_sets::PairQuantity& quantity : pair_sets::pair_quantities()) {
    histograms.push_back({quantity.name, quantity.edges, pair_sets::counts_in_bins(successes, quantity),
                          pair_sets::counts_in_bins(failures, quantity)});
  }
  return histograms;
}

text::TextTable paper_failures_table(const StoredResult& result, const std::string& algorithm) {
  text::TextTable table{"failures",
                        "Failures of " + algorithm + " on " + result.experiment.set_name,
                        {"Quantity", "From", "To", "Successes", "Failures", "Failed"},
                        {},
                        ""};
  for (const FailureHistogram& histogram : failure_histograms(result, algorithm)) {
    for (std::size_t i = 0; i < histogram.successes.size(); ++i) {
      const double all = static_cast<double>(histogram.successes[i] + histogram.failures[i]);
      if (all > 0.0) {
        table.rows.push_back({histogram.quantity, text::fixed(histogram.edges[i], 1),
                              text::fixed(histogram.edges[i + 1], 1), std::to_string(histogram.successes[i]),
                              std::to_string(histogram.failures[i]),
                              text::percent(static_cast<double>(histogram.failures[i]) / all, 1)});
      }
    }
  }
  return table;
}

}  // namespace loopmark::evaluation

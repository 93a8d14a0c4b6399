// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/result_tables.hpp"

#include <algorithm>

namespace loopmark::evaluation {
namespace {

std::string range_text(const statistics::Interval& interval) {
  return text::fixed(100.0 * interval.low, 1) + " - " + text::fixed(100.0 * interval.high, 1);
}

std::string bin_text(double low, double high) {
  const int decimals = high <= 1.0 ? 2 : 0;
  return text::fixed(low, decimals) + " - " + text::fixed(high, decimals);
}

}  // namespace

text::TextTable overview_table(const Experiment& experiment, const std::vector<AlgorithmSummary>& summaries) {
  text::TextTable table{
      "overview",
      "Recall at " + text::fixed(experiment.criterion.max_rotation_deg, 1) + " deg / " +
          text::fixed(experiment.criterion.max_translation_m, 2) + " m on " + experiment.set_name,
      {"Algorithm", "Pairs", "Recall", "95 % interval", "TE median (m)", "RE median (deg)", "Answered",
       "of these wrong"},
      {},
      "Recall counts the best answer of every pair, as the paper does, whether or not the algorithm stands "
      "for it; intervals are Wilson's."};
  for (const AlgorithmSummary& s : summaries) {
    table.rows.push_back({s.name, std::to_string(s.pairs), text::percent(s.recall()), range_text(s.recall_interval),
                          text::fixed(s.te_m.median, 3), text::fixed(s.re_deg.median, 3), std::to_string(s.answered),
                          std::to_string(s.answered_wrong)});
  }
  return table;
}

text::TextTable times_table(const std::vector<AlgorithmSummary>& summaries) {
  text::TextTable table{"times",
                        "Seconds a pair",
                        {"Algorithm", "Paper's, mean", "median", "95 %", "Whole, mean", "median", "95 %"},
                        {},
                        "The paper's accounting leaves out downsampling, features and the search for the first nearest "
                        "neighbour; whole: from the raw scans to the answer."};
  for (const AlgorithmSummary& s : summaries) {
    table.rows.push_back({s.name, text::fixed(s.paper_seconds.mean, 3), text::fixed(s.paper_seconds.median, 3),
                          text::fixed(s.paper_seconds.p95, 3), text::fixed(s.total_seconds.mean, 3),
                          text::fixed(s.total_seconds.median, 3), text::fixed(s.total_seconds.p95, 3)});
  }
  std::erase_if(table.rows, [](const auto& row) { return row[1] == "-" && row[4] == "-"; });
  return table;
}

text::TextTable errors_table(const std::vector<AlgorithmSummary>& summaries) {
  text::TextTable table{"errors",
                        "Errors over all pairs and over successes",
                        {"Algorithm", "TE mean (cm)", "TE 50 %", "TE 95 %", "RE mean (deg)", "RE 50 %", "RE 95 %",
                         "TE mean, successes", "TE 50 %", "TE 95 %", "RE mean, successes", "RE 50 %", "RE 95 %"},
                        {},
                        "A failure counts as the identity."};
  for (const AlgorithmSummary& s : summaries) {
    std::vector<std::string> row = {s.name};
    for (const auto& [te, re] : {std::pair{s.te_m, s.re_deg}, std::pair{s.te_success_m, s.re_success_deg}}) {
      for (const double value : {te.mean, te.median, te.p95}) {
        row.push_back(text::fixed(100.0 * value, 2));
      }
      for (const double value : {re.mean, re.median, re.p95}) {
        row.push_back(text::fixed(value, 2));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

text::TextTable bins_table(const std::vector<AlgorithmSummary>& summaries, const std::string& name,
                           const std::string& caption, std::vector<RecallBin> AlgorithmSummary::*bins) {
  text::TextTable table{name, caption, {"Algorithm"}, {}, "Wilson's 95 % intervals in brackets."};
  const std::vector<RecallBin>& first = summaries.front().*bins;
  for (const RecallBin& bin : first) {
    if (bin.pairs > 0) {
      table.columns.push_back(bin_text(bin.low, bin.high) + ": " + std::to_string(bin.pairs) + " pairs");
    }
  }
  for (const AlgorithmSummary& s : summaries) {
    std::vector<std::string> row = {s.name};
    for (std::size_t b = 0; b < first.size(); ++b) {
      const RecallBin& bin = (s.*bins)[b];
      if (first[b].pairs > 0) {
        row.push_back(bin.pairs == 0 ? "-"
                                     : text::percent(bin.recall(), 1) + " (" +
                                           range_text(statistics::wilson_interval(bin.successes, bin.pairs)) + ")");
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

text::TextTable certainty_table(const std::vector<AlgorithmSummary>& summaries) {
  text::TextTable table{"certainty",
                        "What the algorithms say of their answers",
                        {"Algorithm", "Answered positives", "of these wrong", "Negatives", "False accepts",
                         "False-accept rate", "95 % interval", "Average precision", "Calibration error"},
                        {},
                        "A false accept is an answer to a pair that shows two different places. Average precision and "
                        "calibration count every scored answer, negatives included."};
  for (const AlgorithmSummary& s : summaries) {
    const bool negatives = s.negatives > 0;
    table.rows.push_back({s.name, std::to_string(s.answered), std::to_string(s.answered_wrong),
                          std::to_string(s.negatives), std::to_string(s.false_accepts),
                          negatives ? text::percent(s.false_accept_rate()) : "-",
                          negatives ? range_text(s.false_accept_interval) : "-",
                          s.has_scores ? text::fixed(s.average_precision, 4) : "-",
                          s.reliability.empty() ? "-" : text::fixed(s.calibration_error, 4)});
  }
  return table;
}

text::TextTable reliability_table_of(const std::vector<AlgorithmSummary>& summaries) {
  text::TextTable table{"reliability",
                        "Reliability: stated probability against share of right answers",
                        {"Algorithm", "P(correct)", "Answers", "Mean P", "Right"},
                        {},
                        ""};
  for (const AlgorithmSummary& s : summaries) {
    for (const statistics::ReliabilityBin& bin : s.reliability) {
      if (bin.count > 0) {
        table.rows.push_back({s.name, text::fixed(bin.low, 1) + " - " + text::fixed(bin.high, 1),
                              std::to_string(bin.count), text::fixed(bin.mean_p, 3),
                              text::fixed(bin.share_correct, 3)});
      }
    }
  }
  return table;
}

text::TextTable stages_table(const std::vector<AlgorithmSummary>& summaries) {
  text::TextTable table{"stages", "Median seconds of each stage", {"Algorithm", "Stage", "Seconds"}, {}, ""};
  for (const AlgorithmSummary& s : summaries) {
    for (const auto& [stage, seconds] : s.stage_medians_s) {
      table.rows.push_back({s.name, stage, text::fixed(seconds, 4)});
    }
  }
  return table;
}

text::TextTable paired_table(const std::vector<PairedTest>& tests) {
  text::TextTable table{"paired",
                        "Paired comparison (McNemar, exact, two-sided)",
                        {"First", "Second", "Both right", "Only first", "Only second", "Neither", "p"},
                        {},
                        ""};
  for (const PairedTest& test : tests) {
    table.rows.push_back({test.first, test.second, std::to_string(test.both), std::to_string(test.only_first),
                          std::to_string(test.only_second), std::to_string(test.neither),
                          text::fixed(test.p_value, 4)});
  }
  return table;
}

std::vector<text::TextTable> result_tables(const StoredResult& result, const std::vector<AlgorithmSummary>& summaries,
                                           const std::vector<PairedTest>& tests) {
  std::vector<text::TextTable> tables = {
      overview_table(result.experiment, summaries),
      errors_table(summaries),
      bins_table(summaries, "by_overlap", "Recall by symmetric overlap", &AlgorithmSummary::by_overlap),
      bins_table(summaries, "by_distance", "Recall by distance (m)", &AlgorithmSummary::by_distance),
      bins_table(summaries, "by_yaw", "Recall by absolute yaw (deg)", &AlgorithmSummary::by_yaw),
      certainty_table(summaries),
      reliability_table_of(summaries),
      times_table(summaries),
      stages_table(summaries),
      paired_table(tests)};
  std::erase_if(tables, [](const text::TextTable& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace loopmark::evaluation

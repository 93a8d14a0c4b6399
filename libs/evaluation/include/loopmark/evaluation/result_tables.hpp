// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The tables of a result.
#pragma once

#include <vector>

#include "loopmark/evaluation/result_folder.hpp"
#include "loopmark/text/text_table.hpp"

namespace loopmark::evaluation {

/// Recall with its interval, errors, what was answered: one row an algorithm.
text::TextTable overview_table(const Experiment& experiment, const std::vector<AlgorithmSummary>& summaries);
/// Seconds a pair: the paper's accounting and the whole.
text::TextTable times_table(const std::vector<AlgorithmSummary>& summaries);
/// Mean, median and 95th percentile of TE and RE, over all pairs and over successes.
text::TextTable errors_table(const std::vector<AlgorithmSummary>& summaries);
/// Recall by bins of one quantity.
text::TextTable bins_table(const std::vector<AlgorithmSummary>& summaries, const std::string& name,
                           const std::string& caption, std::vector<RecallBin> AlgorithmSummary::*bins);
/// What the algorithms say of their own answers; false accepts among the negatives.
text::TextTable certainty_table(const std::vector<AlgorithmSummary>& summaries);
/// Stated probability against share of right answers.
text::TextTable reliability_table_of(const std::vector<AlgorithmSummary>& summaries);
/// Median seconds of each stage.
text::TextTable stages_table(const std::vector<AlgorithmSummary>& summaries);
/// McNemar's test of every two algorithms.
text::TextTable paired_table(const std::vector<PairedTest>& tests);

/// All that apply to the result, in the order of the report.
std::vector<text::TextTable> result_tables(const StoredResult& result, const std::vector<AlgorithmSummary>& summaries,
                                           const std::vector<PairedTest>& tests);

}  // namespace loopmark::evaluation

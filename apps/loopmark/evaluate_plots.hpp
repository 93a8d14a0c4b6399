// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "loopmark/evaluation/result_folder.hpp"
#include "loopmark/report/plot.hpp"

namespace loopmark::app {

/// Recall by bins of one quantity, with intervals.
report::Plot recall_plot(const std::vector<evaluation::AlgorithmSummary>& summaries, const std::string& title,
                         const std::string& quantity,
                         std::vector<evaluation::RecallBin> evaluation::AlgorithmSummary::*bins);
/// Share of pairs whose translation (metres) or rotation (degrees) error is below a value.
report::Plot error_plot(const evaluation::StoredResult& result,
                        const std::vector<evaluation::AlgorithmSummary>& summaries, bool rotation);
/// Recall against median seconds of the paper's accounting.
report::Plot time_plot(const std::vector<evaluation::AlgorithmSummary>& summaries);
report::Plot precision_recall_plot(const std::vector<evaluation::AlgorithmSummary>& summaries);
report::Plot reliability_plot(const std::vector<evaluation::AlgorithmSummary>& summaries);

}  // namespace loopmark::app

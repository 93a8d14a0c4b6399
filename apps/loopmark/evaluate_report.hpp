// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "loopmark/evaluation/experiment.hpp"
#include "loopmark/report/table.hpp"
#include "loopmark/text/text_table.hpp"

namespace loopmark::app {

/// A table of the evaluation room as the report room draws it; cells that are numbers sort as numbers.
report::Table report_table(const text::TextTable& table);

/// Writes report.html into the result folder: the tables, plots, and pictures of at most `pictures` failed pairs of
/// each algorithm where scans can be loaded (`load` may be empty). `perturbations` as in the experiment.
void write_evaluation_report(const std::filesystem::path& folder, const evaluation::StoredResult& result,
                             const evaluation::ScanLoader& load, const std::vector<Pose>& perturbations,
                             std::size_t pictures);

}  // namespace loopmark::app

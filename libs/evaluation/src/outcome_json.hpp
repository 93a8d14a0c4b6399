// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/evaluation/result_folder.hpp"

namespace loopmark::evaluation::internal {

/// What counts of an outcome, as one line of JSON; the times are left out.
std::string outcome_to_line(const Outcome& outcome);
/// The times of an outcome, as one line of JSON.
std::string times_to_line(const Outcome& outcome);

/// Inverse of outcome_to_line. Throws InputError on text that is none.
Outcome outcome_from_line(const std::string& line, const std::string& file);
/// Which outcome the times are of, and the times in its answer.
Outcome times_from_line(const std::string& line, const std::string& file);

std::string experiment_to_json(const Experiment& experiment);
Experiment experiment_from_json(const std::string& text, const std::string& file);

/// summary.json (docs/reference/files.md says what its fields mean).
std::string summary_to_json(const Experiment& experiment, const std::vector<AlgorithmSummary>& summaries,
                            const std::vector<PairedTest>& tests);

}  // namespace loopmark::evaluation::internal

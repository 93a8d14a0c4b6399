// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark evaluate: registration experiments on sets of frame pairs.

#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "evaluate_run.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/result_tables.hpp"

namespace loopmark::app {
namespace {

constexpr const char* kExamples = R"(
Examples:
  loopmark evaluate test.txt --motions test.coarse_motions.txt -o RESULT
      how good are motions that somebody found (no scans are needed)
  loopmark evaluate pairs.txt --data LOGS --negatives negatives.txt -o RESULT
      the registration engine on the pairs of a set; sessions.txt beside the set names the log of each session
  loopmark evaluate pairs.txt --data LOGS --algorithms engine,"command:python3 mine.py" -o RESULT
      beside a program of yours that speaks the line protocol (docs/evaluation.md)
)";

void add_run_options(CLI::App& command, EvaluateArguments& a) {
  command.add_option("set", a.set, "pairs file in the published format (27 columns)");
  command.add_option("--data", a.data, "folder with the scans: a data set, or the logs that sessions.txt names");
  command.add_option("-o,--output", a.output, "result folder; an unfinished one of the same experiment is resumed");
  command.add_option("--algorithms", a.algorithms, "what competes, separated by commas")->delimiter(',');
  command.add_option("--motions", a.motions, "motions somebody found, 19 columns; NAME=FILE or FILE; may be repeated");
  command.add_option("--negatives", a.negatives, "pairs of different places: session_i i session_j j");
  command.add_option("--perturb", a.perturb, "a motion for the source points of every pair, 19 columns");
  command.add_option("--max-rotation", a.criterion.max_rotation_deg, "success: RE below this, degrees (5)");
  command.add_option("--max-translation", a.criterion.max_translation_m, "success: TE below this, metres (0.6)");
  command.add_option("--pairs-at-once", a.pairs_at_once, "pairs worked on at the same time; 0: one a thread");
  command.add_option("--shard", a.shard, "k/N: only part k of N of the pairs");
}

}  // namespace

void print_overview(const StoredResult& result) {
  const auto summaries = summarise_all(result.outcomes, result.experiment.algorithms, result.set);
  std::printf("%s\n", to_markdown(overview_table(result.experiment, summaries)).c_str());
  if (result.experiment.negatives > 0) {
    std::printf("%s\n", to_markdown(certainty_table(summaries)).c_str());
  }
}

Action set_up_evaluate(CLI::App& command, const Globals& globals) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  command.footer(kExamples);
  add_run_options(command, *arguments);
  return [arguments, &globals] { return run_evaluate(*arguments, globals); };
}

}  // namespace loopmark::app

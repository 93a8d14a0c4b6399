// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark evaluate: registration experiments on sets of frame pairs.

#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "evaluate_paper.hpp"
#include "evaluate_report.hpp"
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
  loopmark evaluate pairs.txt --data LOGS --algorithms engine --command "mine=python3 mine.py" --refine icp -o RESULT
      beside a program of yours that speaks the line protocol (docs/guide/evaluation.md), each with and without ICP
  loopmark evaluate pairs.txt --data LOGS --algorithms ransac-ablation --repeats 4 --refine icp -o RESULT
  loopmark evaluate paper ransac-ablation RESULT -o TABLES
      the paper's ablation of RANSAC, with the convex hulls of repeated runs
  loopmark evaluate compare RESULT_A RESULT_B
  loopmark evaluate paper refinement RESULT -o TABLES
  loopmark evaluate merge RESULT
      makes the tables when all shards (--shard 1/4 ... 4/4) are done
)";

void add_input_options(CLI::App& command, EvaluateArguments& a) {
  command.add_option("set", a.set, "pairs file in the published format (27 columns)");
  command.add_option("--data", a.data, "folder with the scans: a data set, or the logs that sessions.txt names");
  command.add_option("--sessions", a.sessions, "lines 'NUMBER LOG'; default: sessions.txt beside the set");
  command.add_option("-o,--output", a.output, "result folder; an unfinished one of the same experiment is resumed");
  command.add_option("--negatives", a.negatives, "pairs of different places: session_i i session_j j");
  command.add_option("--perturb", a.perturb, "a motion for the source points of every pair, 19 columns");
}

void add_run_options(CLI::App& command, EvaluateArguments& a) {
  command
      .add_option(
          "--algorithms", a.algorithms,
          "what competes, separated by commas: engine, the paper's variants by name (ransac_mutual, ransac_gpf, "
          "gnc_clique, sc2, ...), custom (the options of section paper), or groups: paper, ransac-ablation, "
          "gpf-ablation, all")
      ->delimiter(',');
  command.add_option("--motions", a.motions, "motions somebody found, 19 columns: FILE or NAME=FILE; may be repeated");
  command.add_option("--command", a.commands, "a program: COMMAND or NAME=COMMAND; may be repeated");
  command
      .add_option("--refine", a.refine, "each algorithm once more with: icp, sym-icp, bbr, plane-icp, gicp; by commas")
      ->delimiter(',');
  command
      .add_option("--descriptor", a.descriptors,
                  "fsc, fpfh, by commas: the paper's variants use each of them and are called VARIANT@NAME; without it "
                  "fsc, and the variants keep their names")
      ->delimiter(',');
  command.add_option("--features", a.features,
                     "NAME=FOLDER with descriptors FOLDER/SESSION/FRAME.npz (loopmark describe, or any network): the "
                     "paper's variants use them and are called VARIANT@NAME; may be repeated");
  command.add_option("--repeats", a.repeats,
                     "runs of each variant of the paper with other seeds, NAME#1, NAME#2, ... (1)");
  command.add_option("--time-limit", a.time_limit_s, "of a program for one pair, seconds (30)");
  command.add_option("--max-rotation", a.criterion.max_rotation_deg, "success: RE below this, degrees (5)");
  command.add_option("--max-translation", a.criterion.max_translation_m, "success: TE below this, metres (0.6)");
  command.add_option("--pairs-at-once", a.pairs_at_once,
                     "pairs worked on at the same time; 0: one for each thread; 1 for undisturbed times");
  command.add_option("--shard", a.shard, "k/N: only part k of N of the pairs");
  command.add_option("--pictures", a.pictures, "failed pairs that report.html draws at most (500)");
  command.add_flag("--no-check", a.no_check, "do not compare the overlaps of a few pairs with the scans first");
}

struct MergeArguments {
  std::vector<std::filesystem::path> results;
  std::filesystem::path output;
};

void set_up_merge(CLI::App& command, MergeArguments& a, std::function<int()>& chosen) {
  CLI::App* merge = command.add_subcommand("merge", "join shards, or results of other algorithms on the same set");
  merge->add_option("results", a.results, "result folders")->required();
  merge->add_option("-o,--output", a.output, "folder for the joined result; default: the first");
  merge->callback([&a, &chosen] {
    chosen = [&a] {
      const std::filesystem::path target = a.output.empty() ? a.results.front() : a.output;
      const evaluation::StoredResult result = evaluation::merge_results(a.results, target);
      write_evaluation_report(target, result, {}, {}, 0);
      print_overview(result);
      return 0;
    };
  });
}

void set_up_paper(CLI::App& command, PaperArguments& a, std::function<int()>& chosen) {
  CLI::App* paper = command.add_subcommand("paper", "one of the paper's tables or figures from results, theirs beside");
  paper->add_option("table", a.table, "which one")->required()->check(CLI::IsMember(paper_table_names()));
  paper
      ->add_option("inputs", a.inputs,
                   "result folders; matrix, running-times, match-sizes: TEST:TRAIN=RESULT; sets: NAME=PAIRS_FILE")
      ->required();
  paper->add_option("--algorithm", a.algorithm, "failures: of this algorithm (the first)");
  paper->add_option("-o,--output", a.output, "folder for the table as .md, .tex and .html");
  paper->callback([&a, &chosen] { chosen = [&a] { return print_paper_table(a); }; });
}

void set_up_compare(CLI::App& command, CompareArguments& a, std::function<int()>& chosen) {
  CLI::App* compare = command.add_subcommand("compare", "two results of one set side by side, pair by pair");
  compare->add_option("first", a.first, "result folder A")->required();
  compare->add_option("second", a.second, "result folder B")->required();
  compare->add_option("-o,--output", a.output, "folder for compare.csv and compare.html");
  compare->callback([&a, &chosen] { chosen = [&a] { return compare_results(a); }; });
}

}  // namespace

void print_overview(const evaluation::StoredResult& result) {
  const auto summaries = evaluation::summarise_all(result.outcomes, result.experiment.algorithms, result.set);
  std::printf("%s\n", text::to_markdown(evaluation::overview_table(result.experiment, summaries)).c_str());
  const text::TextTable times = evaluation::times_table(summaries);
  if (!times.rows.empty()) {
    std::printf("%s\n", text::to_markdown(times).c_str());
  }
  if (result.experiment.negatives > 0) {
    std::printf("%s\n", text::to_markdown(evaluation::certainty_table(summaries)).c_str());
  }
}

Action set_up_evaluate(CLI::App& command, const Globals& globals) {
  struct Arguments {
    EvaluateArguments run;
    MergeArguments merge;
    PaperArguments paper;
    CompareArguments compare;
    std::function<int()> chosen;
  };
  const auto arguments = std::make_shared<Arguments>();
  command.footer(kExamples);
  command.require_subcommand(0, 1);
  add_input_options(command, arguments->run);
  add_run_options(command, arguments->run);
  set_up_merge(command, arguments->merge, arguments->chosen);
  set_up_paper(command, arguments->paper, arguments->chosen);
  set_up_compare(command, arguments->compare, arguments->chosen);
  return interruptible(
      [arguments, &globals] { return arguments->chosen ? arguments->chosen() : run_evaluate(arguments->run, globals); },
      [arguments]() -> std::string {
        const std::filesystem::path& output = arguments->run.output;
        return output.empty() ? "nothing is written; -o RESULT keeps what is done"
                              : output.string() + " keeps what is done; the same command goes on with it";
      });
}

}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/map_store/run_in_making.hpp"
#include "loopmark/workflows/merge_run.hpp"
#include "merge_text.hpp"

namespace loopmark::app {
namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path output;
  bool one_frame = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark merge runs/day1 runs/day2 runs/day3 -o runs/town     three drives of one town as one map
  loopmark merge runs/town runs/day4 -o runs/town2              a merged run is a run: merge it again
  loopmark merge runs/car runs/robot -o runs/yard --set slam.min_loop_p=0.95
                                                                sensors may differ; be stricter about loops
  loopmark merge runs/day1 runs/day2 -o runs/both --one-frame   true poses of both are in one frame: judge the whole
Runs may be given in any order; nothing needs to be known of where they are. Options are those of the first run and --set.
A drive that does not belong to the others is left out with a warning that says why; it is an error only if no two hang
together. The new run holds what a run of loopmark map holds; the keyframes' files are shared with the runs it came from
by hard links, so that any of them may be deleted.)";

void declare(CLI::App& command, MergeArguments& a) {
  command.add_option("RUN", a.runs, "run folders of loopmark map or merge")->required();
  command.add_option("-o,--output", a.output, "folder of the merged run; must not exist")->required();
  command.add_flag("--one-frame", a.one_frame, "the runs' true poses share one frame: keep them, judge the whole");
  command.footer(kExamples);
}

int merge(const MergeArguments& a, const Globals& globals) {
  if (a.runs.size() < 2) {
    throw InputError("loopmark merge needs two runs or more (see: loopmark merge --help)");
  }
  if (!globals.config_file.empty()) {
    throw InputError(globals.config_file.string(), "", "merged runs keep the options of the first one",
                     "change single ones with --set");
  }
  const workflows::MergeInput input = workflows::read_runs(a.runs);
  const workflows::ProgramOptions options =
      config::load<workflows::ProgramOptions>(a.runs.front() / "config.yaml", globals.settings);
  std::vector<std::string> words = {"merge"};
  words.insert(words.end(), a.runs.begin(), a.runs.end());
  map_store::RunInMaking run(map_store::RunFolder::create(a.output));
  workflows::MergeOutcome outcome = workflows::merge_runs(input, run.folder(), options, a.one_frame, words);
  run.finish();
  outcome.run = run.folder().path();
  print_merge(outcome);
  return 0;
}

}  // namespace

Action set_up_merge(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<MergeArguments>();
  declare(command, *arguments);
  return interruptible(
      [arguments, &globals] { return merge(*arguments, globals); },
      [] { return "nothing is written, the runs are as they were; start again with the same command"; });
}

}  // namespace loopmark::app

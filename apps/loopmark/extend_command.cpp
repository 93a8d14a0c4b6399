// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/printable.hpp"
#include "loopmark/map_export/products.hpp"
#include "loopmark/map_store/run_in_making.hpp"
#include "loopmark/workflows/map_job.hpp"
#include "loopmark/workflows/merge_run.hpp"
#include "merge_text.hpp"

namespace loopmark::app {
namespace fs = std::filesystem;
namespace {

struct ExtendArguments {
  fs::path run;
  fs::path log;
  fs::path output;
  fs::path truth;
  bool one_frame = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark extend runs/town drives/day4 -o runs/town2         map day4, then join it to the town: a new run
  loopmark extend runs/town drives/day4                       the same in its place; the old run stays as runs/town.before-1
  loopmark extend runs/town drives/vlp -o runs/town2 --set log.rate_hz=20
                                                              another sensor; options as in: loopmark config dump
The log is mapped with the run's options (but for those of reading logs and of compensation), as by loopmark map. When it
does not belong to the run, nothing is changed, and its own map is kept as OUTPUT.drive; so it is when the program is
interrupted: the same command goes on with it. A drive of the run that no longer hangs
together with the others (loops vetoed since, other options) is left out with a warning; the old run still holds it.)";

void declare(CLI::App& command, ExtendArguments& a) {
  command.add_option("RUN", a.run, "run folder of loopmark map or merge")->required();
  command.add_option("LOG", a.log, "drive log to add")->required();
  command.add_option("-o,--output", a.output,
                     "new run folder; else the run is replaced and the old one kept beside it");
  command.add_option("--truth", a.truth, "true trajectory of the log (TUM or KITTI), one pose a scan");
  command.add_flag("--one-frame", a.one_frame, "true poses of run and log share one frame: keep them, judge the whole");
  command.footer(kExamples);
}

/// Where the log's own map is made: RUN.drive.
fs::path drive_beside(const fs::path& run) {
  std::string text = run.string();
  while (text.size() > 1 && text.back() == '/') {
    text.pop_back();
  }
  return text + ".drive";
}

/// The run's options for a log that another sensor may have written.
workflows::ProgramOptions options_for_log(const fs::path& run, const Globals& globals) {
  const workflows::ProgramOptions given = globals.options();
  workflows::ProgramOptions options = config::load<workflows::ProgramOptions>(run / "config.yaml", globals.settings);
  options.log = given.log;
  options.slam.compensation = given.slam.compensation;
  return options;
}

/// Makes the log's own map, or goes on with what a killed process left of it.
void map_the_log(const ExtendArguments& a, const Globals& globals, const fs::path& drive) {
  const fs::path log = fs::absolute(a.log);
  if (fs::exists(drive / "manifest.json") &&
      map_export::input_of_manifest(map_store::RunFolder::open(drive)).log == log.string()) {
    return;
  }
  if (workflows::log_of_interrupted(drive) == log) {
    workflows::resume_map(drive, globals.arguments);
  } else {
    workflows::start_map(a.log, a.truth, drive, globals.arguments, options_for_log(a.run, globals));
  }
}

/// The run and the log's map as one. Throws InputError, having changed nothing, when the log's drive does not belong;
/// an earlier drive that no longer hangs together with the others is left out with a warning.
workflows::MergeOutcome join(const ExtendArguments& a, const Globals& globals, const fs::path& drive,
                             fs::path& before) {
  const workflows::MergeInput input = workflows::read_runs({a.run, drive});
  const workflows::ProgramOptions options =
      config::load<workflows::ProgramOptions>(a.run / "config.yaml", globals.settings);
  map_store::RunInMaking run(a.output.empty() ? map_store::RunFolder::revise(a.run)
                                              : map_store::RunFolder::create(a.output));
  workflows::MergeOutcome outcome =
      workflows::merge_runs(input, run.folder(), options, a.one_frame, {"extend", a.run.string(), a.log.string()});
  if (!outcome.map.summary.drives.back().belongs) {
    throw InputError(outcome.warnings.back());
  }
  if (a.output.empty()) {
    before = run.finish_revision();
  } else {
    run.finish();
  }
  outcome.run = run.folder().path();
  return outcome;
}

int extend(const ExtendArguments& a, const Globals& globals) {
  if (!globals.config_file.empty()) {
    throw InputError(globals.config_file.string(), "", "the run keeps its own options",
                     "change single ones with --set");
  }
  workflows::read_runs({a.run});  // what is wrong with it is better told before the log is mapped
  if (!a.output.empty() && fs::exists(a.output)) {
    throw InputError(a.output.string(), "", "is there already and is never overwritten", "choose another name for -o");
  }
  const fs::path drive = drive_beside(a.output.empty() ? a.run : a.output);
  map_the_log(a, globals, drive);
  fs::path before;
  try {
    print_merge(join(a, globals, drive, before));
  } catch (const InputError&) {
    std::fprintf(stderr, "nothing is changed; the log's own map is %s\n", printable(drive.string()).c_str());
    throw;
  }
  if (!before.empty()) {
    std::printf("the run as it was: %s\n", before.c_str());
  }
  fs::remove_all(drive);
  return 0;
}

/// The run is as it was; the log's own map may be there in part or whole.
std::string kept_of_extension(const ExtendArguments& a) {
  const fs::path drive = drive_beside(a.output.empty() ? a.run : a.output);
  const std::string merge = "loopmark merge " + a.run.string() + " " + drive.string() + " -o NEW_RUN";
  if (fs::exists(drive)) {
    return a.run.string() + " is as it was, the log's own map is " + drive.string() + "; go on with: " + merge;
  }
  const bool kept = fs::exists(drive.string() + ".partial");
  return a.run.string() + " is as it was; " + kept_of_run(drive) + (kept ? ", then: " + merge : "");
}

}  // namespace

Action set_up_extend(CLI::App& command, const Globals& globals) {
  auto arguments = std::make_shared<ExtendArguments>();
  declare(command, *arguments);
  return interruptible([arguments, &globals] { return extend(*arguments, globals); },
                       [arguments] { return kept_of_extension(*arguments); });
}

}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "command.hpp"

#include <cstdio>
#include <exception>
#include <map>
#include <new>
#include <system_error>
#include <utility>

#include "commands.hpp"
#include "commit.hpp"
#include "convert_command.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/printable.hpp"
#include "loopmark/core/progress.hpp"
#include "standard_output.hpp"
#include "usage.hpp"

namespace loopmark::app {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      {"doctor", "find out what a drive log or data set is and what is wrong with it", set_up_doctor},
      {"map", "turn a drive log into a loop-closed map", set_up_map},
      {"merge", "join several runs into one map, with no idea where they are", set_up_merge},
      {"extend", "map a log and join it to a run", set_up_extend},
      {"view", "look at a map and change its loops, in the browser", set_up_view},
      {"loops", "list the loops of a run, veto or force some, and solve the map again", set_up_loops},
      {"why", "tell stage by stage why two scans of a run make a loop or not", set_up_why},
      {"relocalize", "find the scans of a log in a map, with no hint where they are", set_up_relocalize},
      {"drill", "cut tracking in a map on purpose and tell how well it is found again", set_up_drill},
      {"simulate", "make a drive log with exact truth", set_up_simulate},
      {"convert", "write a drive log in another format", set_up_convert},
      {"describe", "the descriptors of scans as .npz files", set_up_describe},
      {"balance", "choose balanced sets of frame pairs from drives with poses", set_up_balance},
      {"register", "find the motion between two scans", set_up_register},
      {"replay", "run a recorded registration again", set_up_replay},
      {"evaluate", "registration experiments on sets of frame pairs", set_up_evaluate},
      {"check", "find out whether a run or result is as it was written, and mend what can be mended", set_up_check},
      {"config", "show or check the options", set_up_config},
  };
  return table;
}

workflows::ProgramOptions Globals::options() const {
  return config::load<workflows::ProgramOptions>(config_file, settings);
}

Action interruptible(Action action, std::function<std::string()> kept) {
  return [work = std::move(action), what_is_kept = std::move(kept)] {
    try {
      return work();
    } catch (const Interrupted&) {
      std::fprintf(stderr, "interrupted: %s\n", what_is_kept().c_str());
      return static_cast<int>(ExitCode::kInterrupted);
    }
  };
}

std::string kept_of_run(const std::filesystem::path& run) {
  std::string name = run.string();
  while (name.size() > 1 && name.back() == '/') {
    name.pop_back();
  }
  const std::string ending = ".partial";
  if (name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
    name.resize(name.size() - ending.size());
  }
  if (!std::filesystem::exists(name + ending)) {
    return "no scan was mapped yet, nothing is kept; start again with the same command";
  }
  return name + ending + " keeps what is done; go on with: loopmark map --resume " + name;
}

namespace {

std::string text_of(const std::exception& problem) {
  const bool memory = dynamic_cast<const std::bad_alloc*>(&problem) != nullptr;
  return memory ? "there is not enough memory (free some, raise the limit, or use fewer threads)" : problem.what();
}

int guarded(const Action& action) {
  StandardOutput output;
  try {
    const int code = action();
    output.finish();
    return code;
  } catch (const std::exception& problem) {
    const ExitCode code = exit_code_of(problem);
    const char* const kind = code == ExitCode::kInput      ? "error: "
                             : code == ExitCode::kInternal ? "internal error: "
                                                           : "";
    output.flush();
    std::fprintf(stderr, "%s%s\n", kind, printable(text_of(problem)).c_str());
    return static_cast<int>(code);
  }
}

void add_globals(CLI::App& program, Globals& globals) {
  program.add_option("--config", globals.config_file, "YAML file with options (see: loopmark config dump)");
  program.add_option("--set", globals.settings, "one option, as section.name=value; may be repeated")
      ->allow_extra_args(false);
  program
      .add_option_function<std::string>(
          "--topic", [&globals](const std::string& topic) { globals.settings.push_back("log.sensor_label=" + topic); },
          "bags, MCAP, packets: the topic with the scans (see: loopmark doctor)")
      ->type_name("TOPIC");
  program.add_option("--threads", globals.threads, "number of threads; 0: one for each core");
  program.add_flag("--quiet,-q", globals.quiet, "no progress lines");
  program.set_version_flag("--version", "loopmark " + version_text(), "print the version");
}

}  // namespace

int run(int argc, const char* const* argv) {
  CLI::App program{"loopmark: LiDAR drive logs to maps that can be trusted and found again", "loopmark"};
  program.require_subcommand(1);
  program.fallthrough();
  Globals globals;
  globals.arguments.assign(argv + 1, argv + argc);
  add_globals(program, globals);
  std::map<const CLI::App*, Action> actions;
  for (const Command& command : commands()) {
    CLI::App* sub = program.add_subcommand(command.name, command.summary);
    actions[sub] = command.set_up(*sub, globals);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? program.exit(error) : usage_error(program, error);
  }
  install_interrupt_handler();
  set_thread_count(globals.threads);
  Progress::set_enabled(!globals.quiet);
  return guarded(actions.at(program.get_subcommands().front()));
}

}  // namespace loopmark::app

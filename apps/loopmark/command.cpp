// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "command.hpp"

#include <cstdio>
#include <exception>
#include <map>

#include "commands.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/parallel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/core/version.hpp"

namespace loopmark::app {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      {"doctor", "find out what a drive log or data set is and what is wrong with it", set_up_doctor},
      {"map", "turn a drive log into a loop-closed map", set_up_map},
      {"merge", "join several runs into one map, with no idea where they are", set_up_merge},
      {"extend", "map a log and join it to a run", set_up_extend},
      {"loops", "list the loops of a run, veto or force some, and solve the map again", set_up_loops},
      {"why", "tell stage by stage why two scans of a run make a loop or not", set_up_why},
      {"relocalize", "find the scans of a log in a map, with no hint where they are", set_up_relocalize},
      {"drill", "cut tracking in a map on purpose and tell how well it is found again", set_up_drill},
      {"simulate", "make a drive log with exact truth", set_up_simulate},
      {"balance", "choose balanced sets of frame pairs from drives with poses", set_up_balance},
      {"register", "find the motion between two scans", set_up_register},
      {"replay", "run a recorded registration again", set_up_replay},
      {"evaluate", "registration experiments on sets of frame pairs", set_up_evaluate},
      {"config", "show or check the options", set_up_config},
  };
  return table;
}

workflows::ProgramOptions Globals::options() const {
  return config::load<workflows::ProgramOptions>(config_file, settings);
}

namespace {

int guarded(const Action& action) {
  try {
    return action();
  } catch (const std::exception& problem) {
    const ExitCode code = exit_code_of(problem);
    const char* const kind = code == ExitCode::kInput      ? "error: "
                             : code == ExitCode::kInternal ? "internal error: "
                                                           : "";
    std::fprintf(stderr, "%s%s\n", kind, problem.what());
    return static_cast<int>(code);
  }
}

void add_globals(CLI::App& program, Globals& globals) {
  program.add_option("--config", globals.config_file, "YAML file with options (see: loopmark config dump)");
  program.add_option("--set", globals.settings, "one option, as section.name=value; may be repeated")
      ->allow_extra_args(false);
  program.add_option("--threads", globals.threads, "number of threads; 0: one for each core");
  program.add_flag("--quiet,-q", globals.quiet, "no progress lines");
  program.set_version_flag("--version", std::string("loopmark ") + version(), "print the version");
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
    return program.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kInput);
  }
  install_interrupt_handler();
  set_thread_count(globals.threads);
  Progress::set_enabled(!globals.quiet);
  return guarded(actions.at(program.get_subcommands().front()));
}

}  // namespace loopmark::app

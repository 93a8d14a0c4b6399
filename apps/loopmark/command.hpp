// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The subcommands of the program.
#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "loopmark/core/error.hpp"
#include "loopmark/workflows/options.hpp"

namespace loopmark::app {

/// Options that stand before or behind every subcommand.
struct Globals {
  std::filesystem::path config_file;   ///< --config FILE.yaml
  std::vector<std::string> settings;   ///< --set a.b=c
  std::size_t threads = 0;             ///< --threads N; 0: one a core
  bool quiet = false;                  ///< --quiet
  std::vector<std::string> arguments;  ///< all of them, as given

  /// The defaults, changed by the file and then by --set. Throws InputError with file, line and nearest key.
  workflows::ProgramOptions options() const;
};

/// What a subcommand does once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

/// The action, which says what `kept` says when the user interrupts it: what is left and how to go on.
Action interruptible(Action action, std::function<std::string()> kept);

/// What an interrupted run of loopmark map leaves, and the command that goes on with it.
std::string kept_of_run(const std::filesystem::path& run);

/// One subcommand: declares its options on `command` and returns what to run when it was chosen.
struct Command {
  const char* name;
  const char* summary;
  Action (*set_up)(CLI::App& command, const Globals& globals);
};

/// Every subcommand, in the order of the help.
const std::vector<Command>& commands();

/// Parses the command line and runs the chosen subcommand; turns exceptions into exit codes.
int run(int argc, const char* const* argv);

}  // namespace loopmark::app

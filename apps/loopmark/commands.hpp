// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What sets up each subcommand; the table in command.cpp names them.
#pragma once

#include "command.hpp"

namespace loopmark::app {

Action set_up_config(CLI::App& command, const Globals& globals);
Action set_up_check(CLI::App& command, const Globals& globals);
Action set_up_balance(CLI::App& command, const Globals& globals);
Action set_up_describe(CLI::App& command, const Globals& globals);
Action set_up_doctor(CLI::App& command, const Globals& globals);
Action set_up_drill(CLI::App& command, const Globals& globals);
Action set_up_evaluate(CLI::App& command, const Globals& globals);
Action set_up_extend(CLI::App& command, const Globals& globals);
Action set_up_loops(CLI::App& command, const Globals& globals);
Action set_up_map(CLI::App& command, const Globals& globals);
Action set_up_merge(CLI::App& command, const Globals& globals);
Action set_up_relocalize(CLI::App& command, const Globals& globals);
Action set_up_register(CLI::App& command, const Globals& globals);
Action set_up_replay(CLI::App& command, const Globals& globals);
Action set_up_simulate(CLI::App& command, const Globals& globals);
Action set_up_view(CLI::App& command, const Globals& globals);
Action set_up_why(CLI::App& command, const Globals& globals);

}  // namespace loopmark::app

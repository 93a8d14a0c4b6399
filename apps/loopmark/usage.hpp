// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What is said of a command line that cannot be parsed.
#pragma once

#include <CLI/CLI.hpp>

namespace loopmark::app {

/// Says on standard error what is wrong, with the nearest command or option of an unknown one; returns the exit code.
int usage_error(const CLI::App& program, const CLI::ParseError& error);

}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace loopmark {

/// Exit codes of the program.
enum class ExitCode : int { kOk = 0, kInput = 2, kInternal = 70, kInterrupted = 130 };

/// The user's input or usage is at fault (exit code 2). The message names the file, the place in it
/// where there is one, what is wrong, and the remedy.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& what) : std::runtime_error(what) {}

  /// "FILE:PLACE: PROBLEM (REMEDY)"; an empty place or remedy is left out.
  InputError(const std::string& file, const std::string& place, const std::string& problem,
             const std::string& remedy = "");
};

/// The user asked to stop (SIGINT, SIGTERM); what is done is kept (exit code 130).
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// What the program ends with when this has gone wrong.
ExitCode exit_code_of(const std::exception& problem);

}  // namespace loopmark

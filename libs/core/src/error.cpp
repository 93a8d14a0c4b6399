// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/error.hpp"

#include <new>
#include <system_error>

namespace loopmark {
namespace {

std::string join(const std::string& file, const std::string& place, const std::string& problem,
                 const std::string& remedy) {
  std::string text = file;
  if (!place.empty()) {
    text += ":" + place;
  }
  text += ": " + problem;
  if (!remedy.empty()) {
    text += " (" + remedy + ")";
  }
  return text;
}

}  // namespace

InputError::InputError(const std::string& file, const std::string& place, const std::string& problem,
                       const std::string& remedy)
    : std::runtime_error(join(file, place, problem, remedy)) {}

ExitCode exit_code_of(const std::exception& problem) {
  const bool input = dynamic_cast<const InputError*>(&problem) != nullptr;
  // Of the system: read-only folders, memory, threads. (A filesystem_error is a system_error.)
  const bool system = dynamic_cast<const std::system_error*>(&problem) != nullptr ||
                      dynamic_cast<const std::bad_alloc*>(&problem) != nullptr;
  if (input || system) {
    return ExitCode::kInput;
  }
  return dynamic_cast<const Interrupted*>(&problem) != nullptr ? ExitCode::kInterrupted : ExitCode::kInternal;
}

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/error.hpp"

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
  if (dynamic_cast<const InputError*>(&problem) != nullptr) {
    return ExitCode::kInput;
  }
  return dynamic_cast<const Interrupted*>(&problem) != nullptr ? ExitCode::kInterrupted : ExitCode::kInternal;
}

}  // namespace loopmark

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

}  // namespace loopmark

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "usage.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/config/nearest.hpp"
#include "loopmark/core/error.hpp"

namespace loopmark::app {
namespace {

/// Words that other programs use for what a command here does, and that are not spelled alike.
std::string synonym_of(const std::string& word) {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> table = {
      {"map", {"slam", "build", "mapping", "reconstruct", "run", "resume"}},
      {"relocalize", {"localize", "localise", "relocalise", "localization", "localisation", "relocalization", "find"}},
      {"register", {"align", "icp", "match", "registration"}},
      {"doctor", {"info", "inspect", "check", "diagnose", "validate"}},
      {"evaluate", {"benchmark", "bench", "eval"}},
      {"drill", {"kidnap", "kidnapped"}},
      {"simulate", {"synth", "generate"}},
      {"loops", {"optimize", "optimise", "solve", "graph"}},
      {"config", {"options", "settings", "params", "parameters"}},
      {"why", {"explain"}},
      {"view", {"show", "open", "plot", "visualize", "visualise", "display"}}};
  for (const auto& [command, words] : table) {
    if (std::find(words.begin(), words.end(), word) != words.end()) {
      return command;
    }
  }
  return "";
}

/// The subcommand that was reached, else the program.
const CLI::App& reached(const CLI::App& program) {
  const CLI::App* app = &program;
  while (!app->get_subcommands().empty()) {
    app = app->get_subcommands().back();
  }
  return *app;
}

std::vector<std::string> names_of_subcommands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); })) {
    names.push_back(sub->get_name());
  }
  return names;
}

void add_options(const CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
}

std::string hint(const std::string& nearest) { return nearest.empty() ? "" : ": did you mean '" + nearest + "'?"; }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

std::string unknown_command(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = names_of_subcommands(app);
  std::string nearest = config::nearest_name(word, names);
  const std::string synonym = synonym_of(word);
  if (std::find(names.begin(), names.end(), synonym) != names.end()) {
    nearest = synonym;
  }
  return "there is no command '" + word + "'" + (nearest.empty() ? ": there are " + joined(names) : hint(nearest));
}

std::string unknown_option(const CLI::App& app, const std::string& given) {
  const std::string word = given.substr(0, given.find('='));
  std::vector<std::string> names;
  for (const CLI::App* at = &app; at != nullptr; at = at->get_parent()) {
    add_options(*at, names);
  }
  return "there is no option '" + word + "'" + hint(config::nearest_name(word, names));
}

/// What could not be understood; empty when the error lies elsewhere.
std::string unknown_word(const CLI::App& program) {
  const CLI::App& app = reached(program);
  const std::vector<std::string> words = program.remaining(true);
  const auto option = std::find_if(words.begin(), words.end(),
                                   [](const std::string& word) { return word.size() > 1 && word.front() == '-'; });
  const bool wants_command = app.get_require_subcommand_min() > 0;
  if (!words.empty() && wants_command && words.front().front() != '-') {
    return unknown_command(app, words.front());
  }
  if (option != words.end()) {
    return unknown_option(app, *option);
  }
  return words.empty() ? "" : "'" + words.front() + "' was not expected";
}

}  // namespace

int usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const std::string unknown = unknown_word(program);
  const CLI::App& app = reached(program);
  std::string command = app.get_name();
  for (const CLI::App* at = app.get_parent(); at != nullptr; at = at->get_parent()) {
    command = at->get_name() + " " + command;
  }
  std::fprintf(stderr, "error: %s (see: %s --help)\n", (unknown.empty() ? error.what() : unknown).c_str(),
               command.c_str());
  return static_cast<int>(ExitCode::kInput);
}

}  // namespace loopmark::app

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <string>

#include "command.hpp"
#include "commands.hpp"
#include "loopmark/config/options_io.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::app {
namespace {

struct Arguments {
  std::filesystem::path output;
  std::filesystem::path file;
};

int dump_options(const Globals& globals, const Arguments& arguments) {
  const std::string yaml = workflows::options_as_yaml(globals.options());
  if (arguments.output.empty()) {
    std::fputs(yaml.c_str(), stdout);
  } else {
    storage::write_file_atomically(arguments.output, yaml);
  }
  return 0;
}

int check_file(const Globals& globals, const Arguments& arguments) {
  Globals checked = globals;
  checked.config_file = arguments.file;
  (void)checked.options();
  std::printf("%s: fine\n", arguments.file.c_str());
  return 0;
}

}  // namespace

Action set_up_config(CLI::App& command, const Globals& globals) {
  const auto arguments = std::make_shared<Arguments>();
  command.require_subcommand(1);
  CLI::App* dump = command.add_subcommand("dump", "print all options as YAML, with --config and --set applied");
  dump->add_option("-o,--output", arguments->output, "write to this file instead");
  CLI::App* check = command.add_subcommand("check", "check a file of options");
  check->add_option("FILE", arguments->file, "YAML file")->required();
  const char* examples =
      "Examples:\n"
      "  loopmark config dump                                all options with their defaults and what they mean\n"
      "  loopmark config dump --set registration.seed=7      the same with one changed\n"
      "  loopmark config check my.yaml                       says file, line and the nearest name of a wrong option\n";
  for (CLI::App* app : {&command, dump, check}) {
    app->footer(examples);
  }
  return [=, &globals] { return dump->parsed() ? dump_options(globals, *arguments) : check_file(globals, *arguments); };
}

}  // namespace loopmark::app

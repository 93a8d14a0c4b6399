// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Option structs (loopmark/core/options.hpp) from YAML files and "section.name=value" settings, and back.
///
///   MyOptions options;
///   config::apply(options, config::parse_yaml(text, "my.yaml"));
///   config::check_all(options);
///   std::string yaml = config::dump(options);
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/config/visitors.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::config {

/// Sets the options that `node` names; the others keep their values. Throws InputError with file, line, and the
/// nearest key on an unknown key, and with what was expected on an ill-typed value; `options` may then be half set.
template <class Options>
void apply(Options& options, const Node& node) {
  if (node.kind == Node::Kind::kNull) {
    return;
  }
  PathCollector collector;
  describe(collector, options);
  Reader reader(node, "", collector.paths());
  describe(reader, options);
  reader.finish();
}

/// Calls the check() of every section that has one; the message names the section and where the value was set, as far
/// as `sources` (the applied nodes, the last one wins) tell. Throws InputError.
template <class Options>
void check_all(Options& options, const std::vector<Node>& sources = {}) {
  Checker checker(sources);
  checker.section("", options, "");
}

/// All options as YAML with a comment each; apply() of the result gives the same options.
template <class Options>
std::string dump(const Options& options) {
  Options copy = options;
  Dumper dumper;
  describe(dumper, copy);
  return dumper.text();
}

/// The defaults, changed by the file (none when empty), then by each "section.name=value", then checked.
template <class Options>
Options load(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  std::vector<Node> sources;
  if (!file.empty()) {
    sources.push_back(parse_yaml(storage::read_file(file), file.string()));
  }
  for (const std::string& setting : settings) {
    sources.push_back(parse_setting(setting));
  }
  Options options;
  for (const Node& source : sources) {
    apply(options, source);
  }
  check_all(options, sources);
  return options;
}

}  // namespace loopmark::config

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The visitors that describe() functions are called with; use loopmark/config/options_io.hpp.
#pragma once

#include <string>
#include <vector>

#include "loopmark/config/node.hpp"
#include "loopmark/config/scalar.hpp"
#include "loopmark/core/options.hpp"

namespace loopmark::config {

/// "section.name", or the name alone at the top.
std::string join_path(const std::string& section, const std::string& name);

/// Collects the dotted paths of all fields.
class PathCollector {
 public:
  template <class Value>
  void field(const std::string& name, Value& /*value*/, const std::string& /*comment*/) {
    paths_.push_back(join_path(section_, name));
  }
  template <class Enum>
  void choice(const std::string& name, Enum& /*value*/, const Choices<Enum>& /*choices*/,
              const std::string& /*comment*/) {
    paths_.push_back(join_path(section_, name));
  }
  template <class Options>
  void section(const std::string& name, Options& options, const std::string& /*comment*/) {
    const std::string outer = section_;
    section_ = join_path(outer, name);
    describe(*this, options);
    section_ = outer;
  }
  const std::vector<std::string>& paths() const { return paths_; }

 private:
  std::string section_;
  std::vector<std::string> paths_;
};

/// Sets fields from one map of a YAML tree.
class Reader {
 public:
  /// `node` is the section at `path` (empty: the whole); `all_paths` are for the suggestion on an unknown key.
  Reader(const Node& node, std::string path, const std::vector<std::string>& all_paths);

  template <class Value>
  void field(const std::string& name, Value& value, const std::string& /*comment*/) {
    if (const Node* node = find(name)) {
      read_value(*node, join_path(path_, name), value);
    }
  }
  template <class Enum>
  void choice(const std::string& name, Enum& value, const Choices<Enum>& choices, const std::string& /*comment*/) {
    const Node* node = find(name);
    if (node == nullptr) {
      return;
    }
    std::vector<std::string> names;
    for (const auto& [text, meaning] : choices) {
      if (node->kind == Node::Kind::kScalar && node->scalar == text) {
        value = meaning;
        return;
      }
      names.push_back(text);
    }
    no_such_choice(*node, join_path(path_, name), names);
  }
  template <class Options>
  void section(const std::string& name, Options& options, const std::string& /*comment*/) {
    const Node* node = find(name);
    if (node != nullptr && node->kind != Node::Kind::kNull) {
      Reader reader(*node, join_path(path_, name), all_paths_);
      describe(reader, options);
      reader.finish();
    }
  }
  /// Throws InputError when the map holds a key that no field asked for.
  void finish() const;

 private:
  const Node* find(const std::string& name);
  [[noreturn]] static void no_such_choice(const Node& node, const std::string& path,
                                          const std::vector<std::string>& names);

  const Node& node_;
  std::string path_;
  const std::vector<std::string>& all_paths_;
  std::vector<std::string> known_;
};

/// Writes YAML with comments.
class Dumper {
 public:
  template <class Value>
  void field(const std::string& name, Value& value, const std::string& comment) {
    line(name, write_value(value), comment);
  }
  template <class Enum>
  void choice(const std::string& name, Enum& value, const Choices<Enum>& choices, const std::string& comment) {
    std::string chosen;
    std::vector<std::string> names;
    for (const auto& [text, meaning] : choices) {
      names.push_back(text);
      chosen = meaning == value ? text : chosen;
    }
    choice_line(name, chosen, names, comment);
  }
  template <class Options>
  void section(const std::string& name, Options& options, const std::string& comment) {
    begin_section(name, comment);
    describe(*this, options);
    --depth_;
  }
  const std::string& text() const { return text_; }

 private:
  void line(const std::string& name, const std::string& value, const std::string& comment);
  void choice_line(const std::string& name, const std::string& value, const std::vector<std::string>& names,
                   const std::string& comment);
  void begin_section(const std::string& name, const std::string& comment);

  int depth_ = 0;
  std::string text_;
};

/// Calls check(options) of every section that has one.
class Checker {
 public:
  explicit Checker(const std::vector<Node>& sources) : sources_(sources) {}

  template <class Value>
  void field(const std::string& /*name*/, Value& /*value*/, const std::string& /*comment*/) {}
  template <class Enum>
  void choice(const std::string& /*name*/, Enum& /*value*/, const Choices<Enum>& /*choices*/,
              const std::string& /*comment*/) {}
  template <class Options>
  void section(const std::string& name, Options& options, const std::string& /*comment*/) {
    const std::string outer = section_;
    section_ = join_path(outer, name);
    if constexpr (requires { check(options); }) {
      run([&] { check(options); });
    }
    describe(*this, options);
    section_ = outer;
  }

 private:
  template <class Check>
  void run(const Check& check_section) const {
    try {
      check_section();
    } catch (const InputError& error) {
      rethrow(error.what());
    }
  }
  [[noreturn]] void rethrow(const std::string& message) const;

  const std::vector<Node>& sources_;
  std::string section_;
};

}  // namespace loopmark::config

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/config/visitors.hpp"

#include <algorithm>

#include "loopmark/config/nearest.hpp"
#include "loopmark/core/error.hpp"

namespace loopmark::config {
namespace {

constexpr std::size_t kCommentColumn = 40;

std::string joined(const std::vector<std::string>& names, const std::string& separator) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : separator) + name;
  }
  return text;
}

/// The node at a dotted path, or nullptr.
const Node* find_path(const Node& root, const std::string& path) {
  const std::size_t dot = path.find('.');
  for (const auto& [name, child] : root.keys) {
    if (name == path.substr(0, dot)) {
      return dot == std::string::npos ? &child : find_path(child, path.substr(dot + 1));
    }
  }
  return nullptr;
}

}  // namespace

std::string join_path(const std::string& section, const std::string& name) {
  return section.empty() || name.empty() ? section + name : section + "." + name;
}

Reader::Reader(const Node& node, std::string path, const std::vector<std::string>& all_paths)
    : node_(node), path_(std::move(path)), all_paths_(all_paths) {
  if (node.kind != Node::Kind::kMap) {
    wrong_type(node, path_.empty() ? "options" : path_, "a section with names and values");
  }
}

const Node* Reader::find(const std::string& name) {
  known_.push_back(name);
  for (const auto& [key, value] : node_.keys) {
    if (key == name) {
      return &value;
    }
  }
  return nullptr;
}

void Reader::finish() const {
  for (const auto& [key, value] : node_.keys) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) {
      continue;
    }
    const std::string sibling = nearest_name(key, known_);
    const std::string path = join_path(path_, key);
    const std::string nearest = sibling.empty() ? nearest_path(path, all_paths_) : join_path(path_, sibling);
    throw InputError(value.place.file, value.place.line_text(), "unknown option '" + path + "'",
                     nearest.empty() ? "'loopmark config dump' lists all" : "did you mean '" + nearest + "'?");
  }
}

void Reader::no_such_choice(const Node& node, const std::string& path, const std::vector<std::string>& names) {
  wrong_type(node, path, "one of " + joined(names, ", "));
}

void Dumper::line(const std::string& name, const std::string& value, const std::string& comment) {
  std::string start = std::string(static_cast<std::size_t>(2 * depth_), ' ') + name + ": " + value;
  start.resize(std::max(start.size() + 2, kCommentColumn), ' ');
  text_ += start + "# " + comment + "\n";
}

void Dumper::choice_line(const std::string& name, const std::string& value, const std::vector<std::string>& names,
                         const std::string& comment) {
  line(name, value, comment + " (" + joined(names, " | ") + ")");
}

void Dumper::begin_section(const std::string& name, const std::string& comment) {
  const std::string indent(static_cast<std::size_t>(2 * depth_), ' ');
  if (depth_ == 0 && !text_.empty()) {
    text_ += "\n";
  }
  text_ += indent + "# " + comment + "\n" + indent + name + ":\n";
  ++depth_;
}

void Checker::rethrow(const std::string& message) const {
  const std::string prefix = "option ";
  const std::size_t colon = message.find(':');
  if (message.rfind(prefix, 0) != 0 || colon == std::string::npos) {
    throw InputError("option " + section_ + ": " + message);
  }
  const std::string path = join_path(section_, message.substr(prefix.size(), colon - prefix.size()));
  for (auto source = sources_.rbegin(); source != sources_.rend(); ++source) {
    if (const Node* node = find_path(*source, path)) {
      throw InputError(node->place.file, node->place.line_text(), path + message.substr(colon));
    }
  }
  throw InputError("option " + path + message.substr(colon));
}

}  // namespace loopmark::config

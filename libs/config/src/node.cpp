// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/config/node.hpp"

#include <yaml-cpp/yaml.h>

#include <utility>

#include "loopmark/core/error.hpp"

namespace loopmark::config {
namespace {

Place place_of(const YAML::Node& yaml, const std::string& file) { return {file, yaml.Mark().line + 1}; }

constexpr std::size_t kDeepest = 64;    // options nest three deep
constexpr std::size_t kMost = 100'000;  // values; all options together are some hundreds

/// From yaml-cpp's nodes to ours. An alias stands for a whole subtree each time, so that a short file may mean a tree
/// without end: depth and number of values are bounded.
class Converter {
 public:
  explicit Converter(const std::string& file) : file_(file) {}
  Node convert(const YAML::Node& yaml, std::size_t depth);

 private:
  void add_key(Node& map, const YAML::Node& key, const YAML::Node& value, std::size_t depth);
  void count(const Place& place, std::size_t depth);

  const std::string& file_;
  std::size_t values_ = 0;
};

void Converter::count(const Place& place, std::size_t depth) {
  if (depth > kDeepest) {
    throw InputError(file_, place.line_text(),
                     "values are nested more than " + std::to_string(kDeepest) + " deep (an alias that holds itself?)",
                     "write the values out");
  }
  if (++values_ > kMost) {
    throw InputError(file_, place.line_text(), "more than " + std::to_string(kMost) + " values (aliases of aliases?)",
                     "write out those that are meant");
  }
}

void Converter::add_key(Node& map, const YAML::Node& key, const YAML::Node& value, std::size_t depth) {
  const std::string& file = file_;
  const Place place = place_of(key, file);
  if (!key.IsScalar()) {
    throw InputError(file, place.line_text(), "a key must be a name");
  }
  for (const auto& [name, other] : map.keys) {
    if (name == key.Scalar()) {
      throw InputError(file, place.line_text(),
                       "'" + name + "' is given twice, first in line " + other.place.line_text(), "remove one of them");
    }
  }
  Node node = convert(value, depth);
  node.place = place;
  map.keys.push_back({key.Scalar(), std::move(node)});
}

Node Converter::convert(const YAML::Node& yaml, std::size_t depth) {
  Node node;
  node.place = place_of(yaml, file_);
  count(node.place, depth);
  switch (yaml.Type()) {
    case YAML::NodeType::Scalar:
      node.kind = Node::Kind::kScalar;
      node.scalar = yaml.Scalar();
      break;
    case YAML::NodeType::Sequence:
      node.kind = Node::Kind::kSequence;
      for (const YAML::Node& item : yaml) {
        node.items.push_back(convert(item, depth + 1));
      }
      break;
    case YAML::NodeType::Map:
      node.kind = Node::Kind::kMap;
      for (const auto& entry : yaml) {
        add_key(node, entry.first, entry.second, depth + 1);
      }
      break;
    default:
      break;
  }
  return node;
}

void set_file(Node& node, const Place& place) {
  node.place = place;
  for (Node& item : node.items) {
    set_file(item, place);
  }
  for (auto& [name, value] : node.keys) {
    set_file(value, place);
  }
}

}  // namespace

Node parse_yaml(const std::string& text, const std::string& file) {
  try {
    return Converter(file).convert(YAML::Load(text), 0);
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : std::to_string(error.mark.line + 1);
    throw InputError(file, line, "not valid YAML: " + error.msg);
  }
}

Node parse_setting(const std::string& setting) {
  const Place place{"--set " + setting, 0};
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError(place.file, "", "not of the form section.name=value");
  }
  Node node = parse_yaml(setting.substr(equals + 1), place.file);
  std::string path = setting.substr(0, equals);
  while (!path.empty()) {
    const std::size_t dot = path.rfind('.');
    Node parent;
    parent.kind = Node::Kind::kMap;
    parent.keys.push_back({dot == std::string::npos ? path : path.substr(dot + 1), std::move(node)});
    node = std::move(parent);
    path = dot == std::string::npos ? "" : path.substr(0, dot);
  }
  set_file(node, place);
  return node;
}

}  // namespace loopmark::config

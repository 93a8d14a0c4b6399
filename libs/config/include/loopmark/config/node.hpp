// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace loopmark::config {

/// Where a value was written, for messages.
struct Place {
  std::string file;  ///< a file's name, or "--set a.b=c"
  int line = 0;      ///< from 1; 0: there are no lines

  std::string line_text() const { return line > 0 ? std::to_string(line) : std::string(); }
};

struct NodeKey;

/// A YAML document as a plain value that knows where each part was written.
struct Node {
  enum class Kind { kNull, kScalar, kSequence, kMap };

  Kind kind = Kind::kNull;
  Place place;
  std::string scalar;         ///< kScalar: the text, unquoted
  std::vector<Node> items;    ///< kSequence
  std::vector<NodeKey> keys;  ///< kMap, in the order of the file
};

/// A key of a map and its value, whose place is that of the key.
struct NodeKey {
  std::string name;
  Node value;
};

/// Parses YAML text. Throws InputError with file and line on malformed YAML and on a key given twice.
Node parse_yaml(const std::string& text, const std::string& file);

/// The tree that stands for "a.b.c=value" (the value in YAML's notation). Throws InputError when there is no '='.
Node parse_setting(const std::string& setting);

}  // namespace loopmark::config

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/config/scalar.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "loopmark/core/error.hpp"

namespace loopmark::config {
namespace {

std::string describe_node(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kScalar:
      return "'" + node.scalar + "'";
    case Node::Kind::kSequence:
      return "a list";
    case Node::Kind::kMap:
      return "a section";
    default:
      return "nothing";
  }
}

/// The whole scalar as a number, or false.
template <class Number>
bool parse_number(const Node& node, Number& value) {
  if (node.kind != Node::Kind::kScalar || node.scalar.empty()) {
    return false;
  }
  const char* begin = node.scalar.data();
  const char* end = begin + node.scalar.size();
  const auto [stop, error] = std::from_chars(begin + (*begin == '+' ? 1 : 0), end, value);
  return error == std::errc() && stop == end;
}

template <class Floating>
std::string shortest(Floating value) {
  std::array<char, 64> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  std::string number(text.data(), result.ptr);
  const bool whole = number.find_first_not_of("-0123456789") == std::string::npos;
  return whole ? number + ".0" : number;
}

template <class T>
std::string write_list(const std::vector<T>& values) {
  std::string text = "[";
  for (const T& value : values) {
    text += (text.size() > 1 ? ", " : "") + write_value(value);
  }
  return text + "]";
}

template <class T>
void read_list(const Node& node, const std::string& path, const char* expected, std::vector<T>& values) {
  if (node.kind != Node::Kind::kSequence) {
    wrong_type(node, path, expected);
  }
  values.clear();
  for (const Node& item : node.items) {
    read_value(item, path, values.emplace_back());
  }
}

}  // namespace

void wrong_type(const Node& node, const std::string& path, const std::string& expected) {
  throw InputError(node.place.file, node.place.line_text(),
                   path + ": expected " + expected + ", got " + describe_node(node));
}

void read_value(const Node& node, const std::string& path, bool& value) {
  const bool yes = node.kind == Node::Kind::kScalar && node.scalar == "true";
  if (!yes && (node.kind != Node::Kind::kScalar || node.scalar != "false")) {
    wrong_type(node, path, "true or false");
  }
  value = yes;
}

void read_value(const Node& node, const std::string& path, double& value) {
  double number = 0.0;
  if (!parse_number(node, number) || !std::isfinite(number)) {
    wrong_type(node, path, "a number");
  }
  value = number;
}

void read_value(const Node& node, const std::string& path, std::string& value) {
  if (node.kind != Node::Kind::kScalar) {
    wrong_type(node, path, "a text");
  }
  value = node.scalar;
}

void read_value(const Node& node, const std::string& path, std::vector<double>& value) {
  read_list(node, path, "a list of numbers, as [1.0, 2.0]", value);
}

void read_value(const Node& node, const std::string& path, std::vector<std::string>& value) {
  read_list(node, path, "a list of texts, as [one, two]", value);
}

std::int64_t read_signed(const Node& node, const std::string& path, std::int64_t low, std::int64_t high) {
  std::int64_t number = 0;
  if (!parse_number(node, number) || number < low || number > high) {
    wrong_type(node, path, "a whole number");
  }
  return number;
}

std::uint64_t read_unsigned(const Node& node, const std::string& path, std::uint64_t high) {
  std::uint64_t number = 0;
  if (!parse_number(node, number) || number > high) {
    wrong_type(node, path, "a whole number, not below 0");
  }
  return number;
}

std::string write_value(bool value) { return value ? "true" : "false"; }
std::string write_value(double value) { return shortest(value); }
std::string write_value(float value) { return shortest(value); }

std::string write_value(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += '\\';
    }
    text += c == '\n' ? "\\n" : std::string(1, c);
  }
  return text + "\"";
}

std::string write_value(const std::vector<double>& value) { return write_list(value); }
std::string write_value(const std::vector<std::string>& value) { return write_list(value); }

}  // namespace loopmark::config

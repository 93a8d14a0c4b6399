// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Values of options to and from YAML scalars. Reading throws InputError with the place and what was expected.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "loopmark/config/node.hpp"

namespace loopmark::config {

/// Throws InputError: "FILE:LINE: PATH: expected WHAT, got ...".
[[noreturn]] void wrong_type(const Node& node, const std::string& path, const std::string& expected);

void read_value(const Node& node, const std::string& path, bool& value);
void read_value(const Node& node, const std::string& path, double& value);
void read_value(const Node& node, const std::string& path, std::string& value);
void read_value(const Node& node, const std::string& path, std::vector<double>& value);
void read_value(const Node& node, const std::string& path, std::vector<std::string>& value);

/// A whole number in [low, high], or unsigned up to high.
std::int64_t read_signed(const Node& node, const std::string& path, std::int64_t low, std::int64_t high);
std::uint64_t read_unsigned(const Node& node, const std::string& path, std::uint64_t high);

template <std::integral Integer>
void read_value(const Node& node, const std::string& path, Integer& value) {
  using Limits = std::numeric_limits<Integer>;
  if constexpr (std::unsigned_integral<Integer>) {
    value = static_cast<Integer>(read_unsigned(node, path, Limits::max()));
  } else {
    value = static_cast<Integer>(read_signed(node, path, Limits::min(), Limits::max()));
  }
}

inline void read_value(const Node& node, const std::string& path, float& value) {
  double wide = 0.0;
  read_value(node, path, wide);
  value = static_cast<float>(wide);
}

/// The shortest text that reads back as the same value.
std::string write_value(bool value);
std::string write_value(double value);
std::string write_value(float value);
std::string write_value(const std::string& value);
std::string write_value(const std::vector<double>& value);
std::string write_value(const std::vector<std::string>& value);
template <std::integral Integer>
std::string write_value(Integer value) {
  return std::to_string(value);
}

}  // namespace loopmark::config

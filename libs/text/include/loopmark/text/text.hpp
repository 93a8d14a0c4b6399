// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Text files of numbers, and names in the order a person expects.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace loopmark::text {

/// The text split at line ends; carriage returns are taken off.
std::vector<std::string_view> split_lines(std::string_view text);

/// The words of a line, separated by spaces, tabs or `separator`.
std::vector<std::string_view> split_words(std::string_view line, char separator = ' ');

/// The whole text as a number; nothing when it is none.
std::optional<double> parse_number(std::string_view text);

/// The whole text as a number of digits only; nothing when it is none or does not fit.
std::optional<std::uint64_t> parse_whole(std::string_view text);

struct NumberRow {
  std::size_t line = 0;  ///< from 1
  std::vector<double> values;
};

/// The rows of a file of numbers; empty lines and those that start with # are skipped. Throws InputError
/// with the line of a word that is no finite number.
std::vector<NumberRow> read_number_rows(const std::filesystem::path& path, char separator = ' ');

/// True when a comes before b, runs of digits compared as numbers: "9.bin" before "10.bin".
bool natural_less(std::string_view a, std::string_view b);

std::string lower_case(std::string_view text);

}  // namespace loopmark::text

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::text {

/// A line of numbers of a text file, with where it stands.
struct NumberRow {
  std::string file;
  std::size_t line = 0;  ///< from 1, the header is line 1
  std::vector<double> values;

  /// Throws InputError at this row.
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy = "") const;
  /// Column `index` (from 0) as a whole number; throws otherwise.
  int integer(std::size_t index) const;
  /// Sixteen columns from `index` on as a rigid motion, its numbers unchanged; throws when it is none.
  Pose motion(std::size_t index) const;
};

/// Calls `row` for every line after the header. Empty lines at the end are allowed. Throws InputError for
/// text that is no number and for rows whose length is none of `columns`.
void for_each_row(const std::filesystem::path& path, std::span<const std::size_t> columns,
                  const std::function<void(const NumberRow&)>& row);

/// Appends a number with 16 decimals, as the published sets are written.
void append_number(std::string& line, double value);

/// Appends the 16 entries of a motion, row by row, each after a space.
void append_motion(std::string& line, const Pose& pose);

}  // namespace loopmark::text

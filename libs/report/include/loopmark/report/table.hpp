// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace loopmark::report {

/// What stands in one place of a table.
struct Cell {
  std::string text;
  std::optional<double> number;  ///< the value behind the text: sorts and aligns to the right
  bool bold = false;

  Cell(std::string words) : text(std::move(words)) {}  // NOLINT(google-explicit-constructor): texts are cells
  Cell(const char* words) : text(words) {}             // NOLINT(google-explicit-constructor)
  Cell(std::string words, double value) : text(std::move(words)), number(value) {}
};

/// A number with a fixed count of decimals; not a number: a dash.
Cell number_cell(double value, int decimals);
/// A share in [0, 1] as a percentage.
Cell percent_cell(double share, int decimals = 1);
/// A whole number.
Cell count_cell(std::size_t count);

/// A table that is written out in several notations.
class Table {
 public:
  explicit Table(std::vector<std::string> columns, std::string caption = "");

  /// Throws std::invalid_argument unless there is a cell for each column.
  Table& row(std::vector<Cell> cells);

  std::string markdown() const;
  std::string latex() const;  ///< a tabular with booktabs rules in a table environment
  std::string html() const;   ///< sortable by a click on a column's name, inside a Page
  std::string csv() const;    ///< RFC 4180
  std::string text() const;   ///< aligned columns for a terminal

  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<Cell>>& rows() const { return rows_; }

 private:
  bool is_numeric(std::size_t column) const;

  std::vector<std::string> columns_;
  std::string caption_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace loopmark::report

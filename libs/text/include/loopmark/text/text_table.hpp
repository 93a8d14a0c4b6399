// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Tables of text, written as Markdown and LaTeX.
#pragma once

#include <string>
#include <vector>

namespace loopmark::text {

/// A table with a caption; every row has as many cells as there are columns. The first column is aligned left,
/// the others right.
struct TextTable {
  std::string name;  ///< file name without ending
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::string note;  ///< below the table: what differs, how it was measured
};

std::string to_markdown(const TextTable& table);
std::string to_latex(const TextTable& table);

/// A number with `decimals` digits; "-" for NaN.
std::string fixed(double value, int decimals);

/// "91.90 %".
std::string percent(double share, int decimals = 2);

}  // namespace loopmark::text

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/text/text_table.hpp"

#include <cmath>
#include <cstdio>
#include <string_view>

#include "loopmark/core/number_text.hpp"

namespace loopmark::text {
namespace {

std::string join(const std::vector<std::string>& cells, const char* between) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += (i == 0 ? "" : between) + cells[i];
  }
  return line;
}

std::string escaped(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) {
      out += '\\';
    }
    out += c;
  }
  return out;
}

std::vector<std::string> escaped(const std::vector<std::string>& cells, std::string_view special) {
  std::vector<std::string> out;
  for (const std::string& cell : cells) {
    out.push_back(escaped(cell, special));
  }
  return out;
}

}  // namespace

std::string to_markdown(const TextTable& table) {
  std::string text = "**" + table.caption + "**\n\n| " + join(escaped(table.columns, "|"), " | ") + " |\n|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += i == 0 ? "---|" : "---:|";
  }
  text += '\n';
  for (const auto& row : table.rows) {
    text += "| " + join(escaped(row, "|"), " | ") + " |\n";
  }
  return table.note.empty() ? text : text + '\n' + table.note + '\n';
}

std::string to_latex(const TextTable& table) {
  constexpr std::string_view kSpecial = "%_&#$";
  std::string text =
      "\\begin{table}\n\\caption{" + escaped(table.caption, kSpecial) + "}\n\\begin{center}\n\\begin{tabular}{l";
  text += std::string(table.columns.empty() ? 0 : table.columns.size() - 1, 'r');
  text += "}\\toprule\n" + join(escaped(table.columns, kSpecial), " & ") + " \\\\\\midrule\n";
  for (const auto& row : table.rows) {
    text += join(escaped(row, kSpecial), " & ") + " \\\\\n";
  }
  text += "\\bottomrule\n\\end{tabular}\n\\end{center}\n";
  if (!table.note.empty()) {
    text += "{\\small " + escaped(table.note, kSpecial) + "}\n";
  }
  return text + "\\end{table}\n";
}

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) {
    return "-";
  }
  return format_text("%.*f", decimals, value);
}

std::string percent(double share, int decimals) {
  return fixed(100.0 * share, decimals) + (std::isnan(share) ? "" : " %");
}

}  // namespace loopmark::text

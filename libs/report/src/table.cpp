// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "text.hpp"

namespace loopmark::report {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

std::string escape_latex(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\textbackslash{}";
    } else if (c == '~' || c == '^') {
      escaped += std::string("\\") + c + "{}";
    } else {
      escaped += std::string("&%$#_{}").find(c) != std::string::npos ? std::string("\\") + c : std::string(1, c);
    }
  }
  return escaped;
}

std::string csv_field(const std::string& text) {
  return text.find_first_of(",\"\n\r") == std::string::npos ? text : "\"" + replaced(text, "\"", "\"\"") + "\"";
}

std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, letters(text)), ' ');
  return right ? space + text : text + space;
}

}  // namespace

Cell number_cell(double value, int decimals) {
  return std::isfinite(value) ? Cell(internal::fixed(value, decimals), value) : Cell("\u2013", -HUGE_VAL);
}

Cell percent_cell(double share, int decimals) {
  return std::isfinite(share) ? Cell(internal::fixed(100.0 * share, decimals) + " %", share)
                              : number_cell(share, decimals);
}

Cell count_cell(std::size_t count) { return {std::to_string(count), static_cast<double>(count)}; }

Table::Table(std::vector<std::string> columns, std::string caption)
    : columns_(std::move(columns)), caption_(std::move(caption)) {}

Table& Table::row(std::vector<Cell> cells) {
  if (cells.size() != columns_.size()) {
    throw std::invalid_argument("table: a row of " + std::to_string(cells.size()) + " cells for " +
                                std::to_string(columns_.size()) + " columns");
  }
  rows_.push_back(std::move(cells));
  return *this;
}

bool Table::is_numeric(std::size_t column) const {
  return !rows_.empty() &&
         std::all_of(rows_.begin(), rows_.end(), [&](const auto& row) { return row[column].number.has_value(); });
}

std::string Table::markdown() const {
  const auto escaped = [](const std::string& text) { return replaced(replaced(text, "|", "\\|"), "\n", " "); };
  std::string head = "|";
  std::string rule = "|";
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    head += " " + escaped(columns_[i]) + " |";
    rule += is_numeric(i) ? "---:|" : "---|";
  }
  std::string text = caption_.empty() ? "" : caption_ + "\n\n";
  text += head + "\n" + rule + "\n";
  for (const auto& row : rows_) {
    text += "|";
    for (const Cell& cell : row) {
      text += cell.bold ? " **" + escaped(cell.text) + "** |" : " " + escaped(cell.text) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string Table::latex() const {
  std::string alignment;
  std::string head;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    alignment += is_numeric(i) ? "r" : "l";
    head += (i > 0 ? " & " : "") + escape_latex(columns_[i]);
  }
  std::string text = "\\begin{table}\n\\centering\n";
  text += "\\begin{tabular}{" + alignment + "}\n\\toprule\n" + head + " \\\\\n\\midrule\n";
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string cell = replaced(escape_latex(row[i].text), "\u2013", "--");
      text += (i > 0 ? " & " : "") + (row[i].bold ? "\\textbf{" + cell + "}" : cell);
    }
    text += " \\\\\n";
  }
  text += "\\bottomrule\n\\end{tabular}\n";
  return text + (caption_.empty() ? "" : "\\caption{" + escape_latex(caption_) + "}\n") + "\\end{table}\n";
}

std::string Table::html() const {
  std::string text = "<table class=\"sortable\">\n";
  if (!caption_.empty()) {
    text += "<caption>" + internal::escape_markup(caption_) + "</caption>\n";
  }
  text += "<thead><tr>";
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    text +=
        std::string(is_numeric(i) ? "<th class=\"number\">" : "<th>") + internal::escape_markup(columns_[i]) + "</th>";
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows_) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Cell& cell = row[i];
      text += is_numeric(i) ? "<td class=\"number\"" : "<td";
      text +=
          cell.number && std::isfinite(*cell.number) ? " data-sort=\"" + internal::fixed(*cell.number, 9) + "\">" : ">";
      text += (cell.bold ? "<b>" + internal::escape_markup(cell.text) + "</b>" : internal::escape_markup(cell.text)) +
              "</td>";
    }
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table>\n";
}

std::string Table::csv() const {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    text += (i > 0 ? "," : "") + csv_field(columns_[i]);
  }
  text += "\n";
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i > 0 ? "," : "") + csv_field(row[i].text);
    }
    text += "\n";
  }
  return text;
}

std::string Table::text() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    widths.push_back(letters(columns_[i]));
    for (const auto& row : rows_) {
      widths[i] = std::max(widths[i], letters(row[i].text));
    }
  }
  std::string text;
  const auto add_line = [&](const auto& text_of) {
    std::string line;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      line += (i > 0 ? "  " : "") + padded(text_of(i), widths[i], is_numeric(i));
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add_line([&](std::size_t i) { return columns_[i]; });
  for (const auto& row : rows_) {
    add_line([&](std::size_t i) { return row[i].text; });
  }
  return text;
}

}  // namespace loopmark::report

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/text/number_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::text {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

void parse_values(std::string_view text, NumberRow& row) {
  row.values.clear();
  std::size_t at = 0;
  while (true) {
    while (at < text.size() && is_space(text[at])) {
      ++at;
    }
    if (at == text.size()) {
      return;
    }
    std::size_t end = at;
    while (end < text.size() && !is_space(text[end])) {
      ++end;
    }
    double value = 0.0;
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + end, value);
    if (error != std::errc() || stop != text.data() + end || !std::isfinite(value)) {
      row.fail("column " + std::to_string(row.values.size() + 1) + " is no number: '" +
               std::string(text.substr(at, std::min<std::size_t>(end - at, 40))) + "'");
    }
    row.values.push_back(value);
    at = end;
  }
}

std::string lengths(std::span<const std::size_t> columns) {
  std::string text;
  for (const std::size_t count : columns) {
    text += (text.empty() ? "" : " or ") + std::to_string(count);
  }
  return text;
}

}  // namespace

void NumberRow::fail(const std::string& problem, const std::string& remedy) const {
  throw InputError(file, "line " + std::to_string(line), problem, remedy);
}

int NumberRow::integer(std::size_t index) const {
  const double value = values.at(index);
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
    fail("column " + std::to_string(index + 1) + " is no whole number");
  }
  return static_cast<int>(value);
}

Pose NumberRow::motion(std::size_t index) const {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) {
    matrix(i / 4, i % 4) = values.at(index + static_cast<std::size_t>(i));
  }
  try {
    rigid_from_matrix(matrix);
  } catch (const std::invalid_argument& error) {
    fail("columns " + std::to_string(index + 1) + " to " + std::to_string(index + 16) +
             " are no rigid motion: " + error.what(),
         "they must be a 4x4 matrix, row by row, of a rotation and a translation in metres");
  }
  Pose pose = Pose::Identity();
  pose.matrix().topRows<3>() = matrix.topRows<3>();
  return pose;
}

void for_each_row(const std::filesystem::path& path, std::span<const std::size_t> columns,
                  const std::function<void(const NumberRow&)>& row_body) {
  const std::string content = storage::read_file(path);
  NumberRow row;
  row.file = path.string();
  std::size_t at = 0;
  for (row.line = 1; at < content.size(); ++row.line) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string_view text(content.data() + at, end - at);
    at = end + 1;
    if (row.line == 1) {
      continue;
    }
    parse_values(text, row);
    if (row.values.empty() && at >= content.size()) {
      return;
    }
    if (std::find(columns.begin(), columns.end(), row.values.size()) == columns.end()) {
      row.fail(std::to_string(row.values.size()) + " columns where " + lengths(columns) + " are expected",
               "is the file complete, and of the right kind?");
    }
    row_body(row);
  }
}

void append_number(std::string& line, double value) { line += format_text("%.16f", value); }

void append_motion(std::string& line, const Pose& pose) {
  const Eigen::Matrix4d& matrix = pose.matrix();
  for (int i = 0; i < 16; ++i) {
    line += ' ';
    append_number(line, matrix(i / 4, i % 4));
  }
}

}  // namespace loopmark::text

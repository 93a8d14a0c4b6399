// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/line_text.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "loopmark/core/error.hpp"
#include "loopmark/core/number_text.hpp"

namespace loopmark::map_store {

LineWriter& LineWriter::whole(std::size_t value) { return word(std::to_string(value)); }

LineWriter& LineWriter::number(double value) { return word(exact_text(value)); }

LineWriter& LineWriter::word(const std::string& value) {
  std::string safe = value.empty() ? "-" : value;
  std::replace_if(
      safe.begin(), safe.end(), [](char c) { return c == ' ' || c == '\n'; }, '_');
  text_ += (text_.empty() ? "" : " ") + safe;
  return *this;
}

LineWriter& LineWriter::pose(const Pose& value) {
  for (int k = 0; k < 12; ++k) {
    number(value.matrix()(k / 4, k % 4));
  }
  return *this;
}

LineWriter& LineWriter::vector(const Vector6d& value) {
  for (int k = 0; k < 6; ++k) {
    number(value[k]);
  }
  return *this;
}

LineWriter& LineWriter::symmetric(const Matrix6d& value) {
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      number(value(row, column));
    }
  }
  return *this;
}

LineWriter& LineWriter::rest(const std::string& value) {
  std::string safe = value;
  std::replace(safe.begin(), safe.end(), '\n', ' ');
  text_ += " " + safe;
  return *this;
}

std::string LineReader::word() {
  const std::size_t end = std::min(text_.find(' ', at_), text_.size());
  if (at_ >= text_.size() || end == at_) {
    throw InputError("record: a field is missing in \"" + text_.substr(0, 40) + "...\"");
  }
  std::string result = text_.substr(at_, end - at_);
  at_ = end + 1;
  return result;
}

std::size_t LineReader::whole() {
  const std::string text = word();
  std::size_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw InputError("record: \"" + text + "\" is no whole number");
  }
  return value;
}

double LineReader::number() {
  const std::string text = word();
  const std::optional<double> value = number_in(text);
  if (!value) {
    throw InputError("record: \"" + text + "\" is no number");
  }
  return *value;
}

Pose LineReader::pose() {
  Pose value = Pose::Identity();
  for (int k = 0; k < 12; ++k) {
    value.matrix()(k / 4, k % 4) = number();
  }
  return value;
}

Vector6d LineReader::vector() {
  Vector6d value;
  for (int k = 0; k < 6; ++k) {
    value[k] = number();
  }
  return value;
}

Matrix6d LineReader::symmetric() {
  Matrix6d value;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      value(row, column) = value(column, row) = number();
    }
  }
  return value;
}

std::string LineReader::rest() {
  const std::string result = at_ < text_.size() ? text_.substr(at_) : "";
  at_ = text_.size();
  return result;
}

}  // namespace loopmark::map_store

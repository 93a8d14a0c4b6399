// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Numbers and words in one line of text; floating point in hexadecimal, so that reading restores the same bytes.
#pragma once

#include <string>

#include "loopmark/core/pose.hpp"

namespace loopmark::map_store {

class LineWriter {
 public:
  LineWriter& whole(std::size_t value);
  LineWriter& number(double value);
  LineWriter& word(const std::string& value);  ///< blanks become underscores
  LineWriter& pose(const Pose& value);
  LineWriter& vector(const Vector6d& value);
  LineWriter& symmetric(const Matrix6d& value);  ///< its upper triangle
  LineWriter& rest(const std::string& value);    ///< last; may hold blanks
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads what LineWriter wrote. Throws InputError where something else stands.
class LineReader {
 public:
  explicit LineReader(const std::string& text) : text_(text) {}
  std::size_t whole();
  double number();
  std::string word();
  Pose pose();
  Vector6d vector();
  Matrix6d symmetric();
  std::string rest();

 private:
  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace loopmark::map_store

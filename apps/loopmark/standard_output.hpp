// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>

namespace loopmark::app {

/// While it lives, all that goes to `stdout` passes printable(): names of files and drives are chosen by others, and a
/// terminal obeys the control characters in them.
class StandardOutput {
 public:
  StandardOutput();
  ~StandardOutput();
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Writes what is left. Throws InputError when any of the output was lost, as on a full disk.
  void finish();
  void flush();

  /// Takes what stdio writes; whole lines go on.
  bool take(const char* bytes, std::size_t count);

 private:
  bool put(const std::string& text);

  std::FILE* before_;
  std::FILE* guarded_;
  std::string waiting_;  ///< the beginning of a line: a character may be cut at the end of a buffer
  int error_ = 0;        ///< errno of the first failure
};

}  // namespace loopmark::app

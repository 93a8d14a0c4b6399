// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace loopmark::evaluation::internal {

/// A program in a process group of its own, spoken to line by line. It is killed with all that it started when this
/// object goes.
class ChildProcess {
 public:
  enum class Read { kLine, kTimeLimit, kEnded };

  /// Runs the command by /bin/sh -c. Throws InputError when that is impossible.
  explicit ChildProcess(const std::string& command);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends one line; false when the program does not listen any more.
  bool write_line(const std::string& line);
  /// Waits for one line (without its end). Lines over 64 kB count as ended. Throws Interrupted.
  Read read_line(std::string& line, double limit_s);
  /// Kills the group and says how the program had ended: "exit code 3", "signal 11", "killed".
  std::string stop();

 private:
  int pid_ = -1;
  int to_child_ = -1;
  int from_child_ = -1;
  std::string buffer_;
};

}  // namespace loopmark::evaluation::internal

// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Runs the program as a user does, in a process of its own.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace loopmark::testing_support {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + the signal where one ended it
  std::string output;  ///< standard output and standard error, as they came
};

/// A program that runs; killed when it is still running at the end of the scope.
class RunningProgram {
 public:
  /// `prepare` runs in the new process before the program does: limits, rights.
  explicit RunningProgram(const std::vector<std::string>& arguments, const std::string& program = LOOPMARK_BINARY,
                          const std::function<void()>& prepare = {})
      : output_(std::tmpfile()) {
    std::vector<std::string> words = {program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) {
      argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    child_ = output_ == nullptr ? -1 : ::fork();
    if (child_ < 0) {
      throw std::runtime_error("cannot start " + program);
    }
    if (child_ == 0) {
      ::dup2(::fileno(output_), STDOUT_FILENO);
      ::dup2(::fileno(output_), STDERR_FILENO);
      if (prepare) {
        prepare();
      }
      ::execvp(argv[0], argv.data());
      ::_exit(127);
    }
  }
  ~RunningProgram() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    std::fclose(output_);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const { ::kill(child_, signal); }

  /// Waits for the end.
  ProgramResult wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    std::rewind(output_);
    std::array<char, 4096> block{};
    for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), output_)) > 0;) {
      result.output.append(block.data(), n);
    }
    return result;
  }

 private:
  std::FILE* output_;
  pid_t child_ = -1;
};

/// Runs `loopmark ARGUMENTS...` to its end.
inline ProgramResult run_program(const std::vector<std::string>& arguments) { return RunningProgram(arguments).wait(); }

}  // namespace loopmark::testing_support

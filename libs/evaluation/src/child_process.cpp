// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "loopmark/core/error.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"

extern char** environ;  // NOLINT: POSIX declares it nowhere

namespace loopmark::evaluation::internal {
namespace {

constexpr std::size_t kLongestLine = 65536;

[[noreturn]] void cannot_start(const std::string& command, int error) {
  throw InputError("cannot start '" + command + "': " + std::strerror(error));
}

/// Starts the command with the pipe ends as its standard input and output.
int spawn(const std::string& command, int input, int output) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  sigaddset(&defaults, SIGINT);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  const std::array<const char*, 4> arguments = {"/bin/sh", "-c", command.c_str(), nullptr};
  pid_t pid = -1;
  const int error =
      posix_spawn(&pid, "/bin/sh", &actions, &attributes, const_cast<char* const*>(arguments.data()), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    cannot_start(command, error);
  }
  return pid;
}

}  // namespace

ChildProcess::ChildProcess(const std::string& command) {
  static const auto ignored = std::signal(SIGPIPE, SIG_IGN);  // a program that is gone is an answer, not our end
  static_cast<void>(ignored);
  std::array<int, 2> down{};
  std::array<int, 2> up{};
  if (::pipe2(down.data(), O_CLOEXEC) != 0) {
    cannot_start(command, errno);
  }
  if (::pipe2(up.data(), O_CLOEXEC) != 0) {
    ::close(down[0]);
    ::close(down[1]);
    cannot_start(command, errno);
  }
  to_child_ = down[1];
  from_child_ = up[0];
  pid_ = spawn(command, down[0], up[1]);
  ::close(down[0]);
  ::close(up[1]);
}

ChildProcess::~ChildProcess() {
  stop();
  ::close(to_child_);
  ::close(from_child_);
}

bool ChildProcess::write_line(const std::string& line) {
  const std::string text = line + '\n';
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(to_child_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return false;
    }
    done += static_cast<std::size_t>(written);
  }
  return true;
}

ChildProcess::Read ChildProcess::read_line(std::string& line, double limit_s) {
  const Stopwatch watch;
  while (true) {
    const std::size_t end = buffer_.find('\n');
    if (end != std::string::npos) {
      line = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      return Read::kLine;
    }
    if (buffer_.size() > kLongestLine) {
      return Read::kEnded;
    }
    check_interrupt();
    const double left = limit_s - watch.seconds();
    if (left <= 0.0) {
      return Read::kTimeLimit;
    }
    pollfd wait{from_child_, POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(std::min(left, 0.2) * 1000.0) + 1) <= 0) {
      continue;
    }
    std::array<char, 4096> chunk{};
    const ssize_t count = ::read(from_child_, chunk.data(), chunk.size());
    if (count == 0 || (count < 0 && errno != EINTR)) {
      return Read::kEnded;
    }
    buffer_.append(chunk.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }
}

std::string ChildProcess::stop() {
  if (pid_ < 0) {
    return "not running";
  }
  int status = 0;
  bool over = ::waitpid(pid_, &status, WNOHANG) == pid_;
  for (int i = 0; i < 20 && !over; ++i) {  // a moment for a program that is just ending
    ::usleep(5000);
    over = ::waitpid(pid_, &status, WNOHANG) == pid_;
  }
  ::kill(-pid_, SIGKILL);
  if (!over) {
    ::waitpid(pid_, &status, 0);
  }
  pid_ = -1;
  if (!over) {
    return "killed";
  }
  return WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                           : "signal " + std::to_string(WTERMSIG(status));
}

}  // namespace loopmark::evaluation::internal

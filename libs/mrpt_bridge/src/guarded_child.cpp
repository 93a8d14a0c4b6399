// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "guarded_child.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "loopmark/core/error.hpp"

namespace loopmark::mrpt_bridge::internal {
namespace {

/// Address space of this process; 0 where there is no /proc.
std::size_t address_space_bytes() {
  unsigned long pages = 0;
  if (std::FILE* const file = std::fopen("/proc/self/statm", "re"); file != nullptr) {
    pages = std::fscanf(file, "%lu", &pages) == 1 ? pages : 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limit_address_space(std::size_t more_bytes) {
  const std::size_t now = address_space_bytes();
  struct rlimit limit {};
  if (now == 0 || ::getrlimit(RLIMIT_AS, &limit) != 0) {
    return;
  }
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_cur, now + more_bytes);
  ::setrlimit(RLIMIT_AS, &limit);
}

void write_all(int file, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t put = ::write(file, bytes.data() + done, bytes.size() - done);
    if (put < 0 && errno == EINTR) {
      continue;
    }
    if (put <= 0) {
      ::_exit(1);  // nobody listens any more
    }
    done += static_cast<std::size_t>(put);
  }
}

std::string read_all(int file) {
  std::string bytes;
  std::array<char, 1U << 16U> part;
  for (;;) {
    const ssize_t got = ::read(file, part.data(), part.size());
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return bytes;
    }
    bytes.append(part.data(), static_cast<std::size_t>(got));
  }
}

bool ended_well(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return false;
    }
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::optional<std::string> in_guarded_child(std::size_t memory_bytes, const std::function<std::string()>& work) {
  std::array<int, 2> pipe_ends{};
  if (::pipe(pipe_ends.data()) != 0) {
    throw InputError(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipe_ends[0]);
    std::signal(SIGPIPE, SIG_IGN);
    limit_address_space(memory_bytes);
    write_all(pipe_ends[1], work());
    ::_exit(0);
  }
  const int problem = errno;
  ::close(pipe_ends[1]);
  const std::string result = child < 0 ? "" : read_all(pipe_ends[0]);
  ::close(pipe_ends[0]);
  if (child < 0) {
    throw InputError(std::string("cannot start a process: ") + std::strerror(problem));
  }
  return ended_well(child) ? std::optional(result) : std::nullopt;
}

}  // namespace loopmark::mrpt_bridge::internal

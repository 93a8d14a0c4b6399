// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "standard_output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "loopmark/core/error.hpp"
#include "loopmark/core/printable.hpp"

namespace loopmark::app {
namespace {

ssize_t write_to(void* cookie, const char* bytes, std::size_t count) {
  return static_cast<StandardOutput*>(cookie)->take(bytes, count) ? static_cast<ssize_t>(count) : 0;
}

}  // namespace

StandardOutput::StandardOutput() : before_(stdout), guarded_(nullptr) {
  std::fflush(before_);
  cookie_io_functions_t functions{};
  functions.write = write_to;
  guarded_ = ::fopencookie(this, "w", functions);
  if (guarded_ == nullptr) {
    return;
  }
  if (::isatty(STDOUT_FILENO) == 1) {
    std::setvbuf(guarded_, nullptr, _IOLBF, BUFSIZ);
  }
  stdout = guarded_;
}

StandardOutput::~StandardOutput() {
  flush();
  if (guarded_ != nullptr) {
    stdout = before_;
    std::fclose(guarded_);
  }
}

bool StandardOutput::put(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      error_ = error_ != 0 ? error_ : errno;
      return false;
    }
    done += static_cast<std::size_t>(written);
  }
  return true;
}

bool StandardOutput::take(const char* bytes, std::size_t count) {
  waiting_.append(bytes, count);
  const std::size_t end = waiting_.rfind('\n') + 1;  // npos + 1: no line yet
  const std::string lines = printable(waiting_.substr(0, end));
  waiting_.erase(0, end);
  return put(lines);
}

void StandardOutput::flush() {
  std::fflush(stdout);
  put(printable(waiting_));
  waiting_.clear();
}

void StandardOutput::finish() {
  flush();
  if (error_ != 0) {
    throw InputError("standard output", "", std::string("cannot write: ") + std::strerror(error_),
                     "part of the output is lost");
  }
}

}  // namespace loopmark::app

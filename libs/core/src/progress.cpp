// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/progress.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <mutex>
#include <utility>

namespace loopmark {
namespace {

std::mutex& sink_mutex() {
  static std::mutex mutex;
  return mutex;
}

LogSink& sink() {
  static LogSink instance = [](Severity severity, const std::string& message) {
    if (severity == Severity::kWarning) {
      std::fprintf(stderr, "warning: %s\n", message.c_str());
    }
  };
  return instance;
}

std::atomic<bool> progress_enabled{true};

bool on_terminal() {
  static const bool terminal = ::isatty(STDERR_FILENO) != 0;
  return terminal;
}

std::string clock_text(double seconds) {
  char text[32];
  const int whole = static_cast<int>(seconds + 0.5);
  std::snprintf(text, sizeof text, "%d:%02d", whole / 60, whole % 60);
  return text;
}

}  // namespace

void set_log_sink(LogSink new_sink) {
  const std::scoped_lock lock(sink_mutex());
  sink() = std::move(new_sink);
}

void log(Severity severity, const std::string& message) {
  const std::scoped_lock lock(sink_mutex());
  if (sink()) {
    sink()(severity, message);
  }
}

Progress::Progress(std::string what, std::size_t total) : what_(std::move(what)), total_(total) {}

Progress::~Progress() { finish(); }

void Progress::set_enabled(bool enabled) { progress_enabled = enabled; }

void Progress::add(std::size_t units, const std::string& note) {
  done_ += units;
  note_ = note;
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> gap = now - shown_;
  const std::chrono::duration<double> since = now - start_;
  if (progress_enabled && since.count() > 1.0 && gap.count() > (on_terminal() ? 0.2 : 10.0)) {
    show(now);
  }
}

void Progress::show(Clock::time_point now) {
  shown_ = now;
  printed_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = elapsed > 0.0 ? static_cast<double>(done_) / elapsed : 0.0;
  std::string line = std::to_string(done_);
  if (total_ > 0) {
    line += "/" + std::to_string(total_);
  }
  char text[96];
  std::snprintf(text, sizeof text, " %s  %.1f/s  %s", what_.c_str(), rate, clock_text(elapsed).c_str());
  line += text;
  if (total_ > done_ && rate > 0.0) {
    line += "  left " + clock_text(static_cast<double>(total_ - done_) / rate);
  }
  if (!note_.empty()) {
    line += "  " + note_;
  }
  std::fprintf(stderr, on_terminal() ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
}

void Progress::finish() {
  if (finished_) {
    return;
  }
  finished_ = true;
  if (printed_) {
    show(Clock::now());
    if (on_terminal()) {
      std::fputc('\n', stderr);
    }
  }
}

}  // namespace loopmark

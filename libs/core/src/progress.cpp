// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/core/progress.hpp"
#include "loopmark/core/printable.hpp"

#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
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
      std::fprintf(stderr, "warning: %s\n", printable(message).c_str());
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

/// What is shown of one phase, and the thread that shows it while units take long.
struct Progress::Line {
  using Clock = std::chrono::steady_clock;

  std::string phase;
  std::string units;
  std::size_t total = 0;
  std::size_t done = 0;
  std::string note;
  Clock::time_point start = Clock::now();
  bool printed = false;
  Line* outer = nullptr;
  std::jthread ticker = {};

  static inline std::mutex mutex;  // of all lines
  static inline Line* innermost = nullptr;

  std::string text() const;
  void show();
  void tick(const std::stop_token& stop);
};

std::string Progress::Line::text() const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
  std::string line = phase;
  char number[64];
  const double rate = static_cast<double>(done) / elapsed;
  if (done > 0 || total > 0) {
    line +=
        (line.empty() ? "" : " ") + std::to_string(done) + (total > 0 ? "/" + std::to_string(total) : "") + " " + units;
    std::snprintf(number, sizeof number, "  %.1f/s", rate);
    line += number;
  }
  line += "  " + clock_text(elapsed);
  if (total > done && done > 0) {
    line += "  left " + clock_text(static_cast<double>(total - done) / rate);
  }
  return note.empty() ? line : line + "  " + note;
}

void Progress::Line::show() {
  printed = true;
  std::fprintf(stderr, on_terminal() ? "\r\033[K%s" : "%s\n", text().c_str());
  std::fflush(stderr);
}

void Progress::Line::tick(const std::stop_token& stop) {
  const auto period = std::chrono::milliseconds(on_terminal() ? 200 : 2000);
  std::condition_variable_any end;
  std::unique_lock lock(mutex);
  auto next = start + std::chrono::milliseconds(1500);
  while (!end.wait_until(lock, stop, next, [] { return false; }) && !stop.stop_requested()) {
    if (innermost == this) {
      show();
    }
    next += period;
  }
}

Progress::Progress(std::string phase, std::string units, std::size_t total) {
  if (!progress_enabled) {
    return;
  }
  line_ = std::make_unique<Line>();
  line_->phase = std::move(phase);
  line_->units = std::move(units);
  line_->total = total;
  {
    const std::scoped_lock lock(Line::mutex);
    line_->outer = Line::innermost;
    Line::innermost = line_.get();
  }
  line_->ticker = std::jthread([line = line_.get()](const std::stop_token& stop) { line->tick(stop); });
}

Progress::Progress(std::string units, std::size_t total) : Progress("", std::move(units), total) {}

Progress::~Progress() { finish(); }

void Progress::set_enabled(bool enabled) { progress_enabled = enabled; }

void Progress::add(std::size_t units, const std::string& note) {
  if (line_) {
    const std::scoped_lock lock(Line::mutex);
    line_->done += units;
    line_->note = note;
  }
}

void Progress::finish() {
  if (!line_) {
    return;
  }
  line_->ticker.request_stop();
  line_->ticker.join();
  const std::scoped_lock lock(Line::mutex);
  if (line_->printed) {
    line_->show();
    if (on_terminal()) {
      std::fputc('\n', stderr);
    }
  }
  for (Line** at = &Line::innermost; *at != nullptr; at = &(*at)->outer) {
    if (*at == line_.get()) {
      *at = line_->outer;
      break;
    }
  }
  line_.reset();
}

}  // namespace loopmark

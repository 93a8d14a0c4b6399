// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Where a library reports to: the program decides what is shown. Libraries never write to std::cout.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace loopmark {

enum class Severity { kDebug, kInfo, kWarning };

/// Receives the messages of the libraries; called from any thread, one at a time.
using LogSink = std::function<void(Severity, const std::string&)>;

/// Replaces the sink; the default writes warnings to standard error.
void set_log_sink(LogSink sink);
void log(Severity severity, const std::string& message);

/// Counts work done and prints a line with rate and time left to standard error: at most five times a
/// second on a terminal (rewriting the line), every ten seconds elsewhere, nothing in the first second
/// or when progress is off.
class Progress {
 public:
  /// `what` names the units: "scans", "pairs". total 0: not known.
  Progress(std::string what, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Adds finished units; `note` is shown behind the rate ("12 keyframes, 3 loops").
  void add(std::size_t units = 1, const std::string& note = "");
  /// Ends the line. Called by the destructor too.
  void finish();

  static void set_enabled(bool enabled);

 private:
  using Clock = std::chrono::steady_clock;
  void show(Clock::time_point now);

  std::string what_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::string note_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
  bool printed_ = false;
  bool finished_ = false;
};

/// Seconds since it was made or reset.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  void reset() { start_ = std::chrono::steady_clock::now(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace loopmark
